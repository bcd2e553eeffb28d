//! The mechanism that is controlled: rig, support and tendons, validated.

use crate::settings::{Settings, SettingsError, TendonParameters};
use leg_model::{
    Direction, Error, Geometry, Load, Rig, Scalar, Support, Tendon, TensionBounds, Twist,
};

/// Rig, support and tendons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mechanism<T> {
    /// Geometry and masses.
    pub rig: Rig<T, 3>,
    /// The central support.
    pub support: Support<T>,
    /// The tendons.
    pub tendons: [Tendon<T>; 3],
    /// The tensions that targets may have.
    pub bounds: TensionBounds<T>,
    /// Highest tension of a target for which `bounds` do not suffice, N: a motor pulls at a quarter of its speed there.
    pub holding_max_n: T,
    /// Lowest tension allowed, N.
    pub f_min_n: T,
    /// Highest tension allowed, N.
    pub f_max_n: T,
    /// The weights without a payload.
    pub leg: Load<T>,
    /// Moment of a payload of 1 kg with the leg horizontal, N·m/kg.
    pub payload_lever: T,
    /// Inertia of the leg without a payload across its axis, about the joint, kg·m²: that of a slender one.
    pub leg_inertia: T,
    /// The same of a payload of 1 kg.
    pub payload_inertia: T,
}

impl<T: Scalar> Mechanism<T> {
    /// Validates what the settings say of the mechanism.
    ///
    /// # Errors
    /// What the model refuses.
    pub fn new(settings: &Settings) -> Result<Self, SettingsError> {
        let parameters = settings.rig.map(T::from);
        let rig = Rig::new(&parameters)?;
        let (f_min_n, f_max_n) = (T::from(settings.f_min_n), T::from(settings.f_max_n));
        let slowed_n = T::from(settings.greatest(|servo| servo.f_max_band_n));
        Ok(Self {
            support: Support::new(settings.support, settings.joint.map(T::from))?,
            tendons: TendonParameters::validated_all(&settings.tendons)?,
            // In the last newtons below the maximum tension a motor is slowed down: a target leads there only where the leg was sent, and by three quarters at the most.
            bounds: TensionBounds::new(f_min_n, f_max_n - slowed_n)?,
            holding_max_n: f_max_n - slowed_n * T::from(0.25),
            f_min_n,
            f_max_n,
            leg: Load::new(&rig, T::zero())?,
            payload_lever: parameters.gravity_m_per_s2 * rig.tip_m(),
            // A slender leg reaches twice as far as its centroid c: m(2c)²/3.
            leg_inertia: parameters.leg_mass_kg
                * parameters.leg_centroid_m
                * parameters.leg_centroid_m
                * T::from(4.0 / 3.0),
            payload_inertia: rig.tip_m() * rig.tip_m(),
            rig,
        })
    }

    /// The geometry of a leg that points along `direction` with an elastic torsion in rad. It is made in `twisted` where
    /// the support twists the leg; elsewhere nothing is copied.
    #[inline(always)]
    pub fn geometry<'a>(
        &'a self,
        direction: &Direction<T>,
        torsion: T,
        twisted: &'a mut Option<Geometry<T, 3>>,
    ) -> &'a Geometry<T, 3> {
        if self.support.twists() {
            let twist = self
                .support
                .twist(direction)
                .composed(&Twist::from_torsion(torsion));
            twisted.insert(self.rig.geometry().twisted(&twist))
        } else if self.support.universal() {
            twisted.insert(self.rig.geometry().twisted(&self.support.twist(direction)))
        } else {
            self.rig.geometry()
        }
    }

    /// Inertia across the leg with a payload, kg·m².
    #[inline(always)]
    pub fn inertia(&self, payload_kg: T) -> T {
        self.leg_inertia + payload_kg * self.payload_inertia
    }

    /// The weights with a payload.
    ///
    /// # Errors
    /// A payload that is refused.
    pub fn load(&self, payload_kg: T) -> Result<Load<T>, Error> {
        Load::new(&self.rig, payload_kg)
    }
}
