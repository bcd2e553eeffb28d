//! The fast path's full pass: kinematics, total stiffness, rotation and tip displacement in one walk over the tendons.

use crate::kinematics::TendonAtPose;
use crate::range::{TENSION_MAX, check_magnitude};
use crate::tendon::check_stiffness;
use crate::{
    Direction, Distribution, Error, FreePlane, Geometry, Kinematics, Load, Quantity, Rig, Scalar,
    Symmetric3, tip_displacement,
};
use nalgebra::{SVector, Vector3};

/// What the full pass computes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FullPass<T, const N: usize> {
    /// Lengths and moments of the tendons.
    pub kinematics: Kinematics<T, N>,
    /// K₁ + exact K₂ + K_load, symmetrised, N·m/rad. At equilibrium the total is symmetric by itself.
    pub stiffness: Symmetric3<T>,
    /// Rotation and displacement under the load. With an error here the other fields are invalid, too: they stand
    /// beside it, not inside, so that each number is written once, as soon as it is known.
    pub deflection: Result<Deflection<T>, Error>,
}

/// A small motion of the leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deflection<T> {
    /// ψ, rad.
    pub rotation: Vector3<T>,
    /// How far that takes the tip, m.
    pub tip_displacement: Vector3<T>,
}

/// Tensions and tangent stiffnesses of the tendons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TendonStates<T, const N: usize> {
    tensions: SVector<T, N>,
    stiffnesses: SVector<T, N>,
}

impl<T: Scalar, const N: usize> TendonStates<T, N> {
    /// Tensions in N and tangent stiffnesses in N/m.
    ///
    /// # Errors
    /// A tension that is not finite or beyond 10⁷ N; a stiffness that no tendon has.
    pub fn new(tensions: SVector<T, N>, stiffnesses: SVector<T, N>) -> Result<Self, Error> {
        for &tension in tensions.iter() {
            check_magnitude(tension, TENSION_MAX, Quantity::Tension)?;
        }
        for &stiffness in stiffnesses.iter() {
            check_stiffness(stiffness)?;
        }
        Ok(Self {
            tensions,
            stiffnesses,
        })
    }

    /// Tensions, N.
    #[must_use]
    #[inline(always)]
    pub fn tensions(&self) -> &SVector<T, N> {
        &self.tensions
    }

    /// Tangent stiffnesses, N/m.
    #[must_use]
    #[inline(always)]
    pub fn stiffnesses(&self) -> &SVector<T, N> {
        &self.stiffnesses
    }
}

/// Full pass for a ball joint: three free rotations, a 3×3 solve.
///
/// [`FullPass::deflection`] is [`Error::TendonCollapsed`] or [`Error::Unstable`], when the leg would buckle.
#[inline(always)]
pub fn full_pass<T: Scalar, const N: usize>(
    rig: &Rig<T, N>,
    direction: &Direction<T>,
    load: &Load<T>,
    tendons: &TendonStates<T, N>,
) -> FullPass<T, N> {
    let solve = |stiffness: &Symmetric3<T>, moment| stiffness.solve_horizontal(moment);
    pass(rig, direction, load, tendons, solve)
}

/// Full pass for a support with two freedoms: a 2×2 solve in its free plane.
///
/// The same errors as in [`full_pass`].
///
/// ```
/// use leg_model::{Direction, FreePlane, Load, Rig, RigParameters, TendonStates, full_pass_in_plane};
///
/// use leg_model::nalgebra::Vector3;
/// let rig = Rig::new(&RigParameters::<f64, 3>::TABLE_1)?;
/// let leaning = Direction::from_angles(0.0, 0.3)?;
/// let plane = FreePlane::torsion_free(&leaning);
/// let states = TendonStates::new(Vector3::repeat(70.0), Vector3::repeat(9.945e4))?;
/// let pass = full_pass_in_plane(&rig, &leaning, &plane, &Load::new(&rig, 1.0)?, &states);
/// let moved_m = pass.deflection?.tip_displacement;
/// let sag_m = moved_m.dot(&moved_m).sqrt();
/// assert!((1e-3..5e-3).contains(&sag_m));
/// # Ok::<(), leg_model::Error>(())
/// ```
#[inline(always)]
pub fn full_pass_in_plane<T: Scalar, const N: usize>(
    rig: &Rig<T, N>,
    direction: &Direction<T>,
    plane: &FreePlane<T>,
    load: &Load<T>,
    tendons: &TendonStates<T, N>,
) -> FullPass<T, N> {
    let solve = |stiffness: &Symmetric3<T>, moment| plane.solve_horizontal(stiffness, moment);
    pass(rig, direction, load, tendons, solve)
}

#[inline(always)]
fn pass<T: Scalar, const N: usize>(
    rig: &Rig<T, N>,
    direction: &Direction<T>,
    load: &Load<T>,
    states: &TendonStates<T, N>,
    solve: impl Fn(&Symmetric3<T>, [T; 2]) -> Result<Vector3<T>, Error>,
) -> FullPass<T, N> {
    let geometry = &rig.geometry;
    let q = direction.half_tangent();
    let mut kinematics = Kinematics::zero();
    let mut sums = Sums::new();
    for (i, pair) in geometry.tendons.iter().enumerate() {
        let tendon = TendonAtPose::new(pair, geometry, &q, direction.gain());
        kinematics.set(i, &tendon);
        sums.add(
            &tendon,
            pair.base,
            states.tensions[i],
            states.stiffnesses[i],
        );
    }
    let stiffness = sums.total(geometry.upper, direction, load);
    // A collapsed tendon makes the stiffness infinite or NaN, which the solve refuses: only then is it named.
    let deflection = match solve(&stiffness, load.horizontal_moment(direction)) {
        Ok(rotation) => Ok(Deflection {
            rotation,
            tip_displacement: tip_displacement(&rotation, direction, rig.tip),
        }),
        Err(error) => Err(kinematics.collapsed().unwrap_or(error)),
    };
    FullPass {
        kinematics,
        stiffness,
        deflection,
    }
}

/// Exact K₂ at constant tensions, symmetrised, N·m/rad, for tensions f = particular +
/// pretension·per_pretension: the part that stays, with K_load, and the part per pretension. The tendons' own stiffness is left out.
#[inline(always)]
pub(crate) fn tension_stiffness<T: Scalar, const N: usize>(
    geometry: &Geometry<T, N>,
    direction: &Direction<T>,
    load: &Load<T>,
    distribution: &Distribution<T, N>,
) -> [Symmetric3<T>; 2] {
    let q = direction.half_tangent();
    let (mut fixed, mut per_pretension) = (Sums::new(), Sums::new());
    for (i, pair) in geometry.tendons.iter().enumerate() {
        let tendon = TendonAtPose::new(pair, geometry, &q, direction.gain());
        fixed.add(&tendon, pair.base, distribution.particular[i], T::zero());
        per_pretension.add(
            &tendon,
            pair.base,
            distribution.per_pretension[i],
            T::zero(),
        );
    }
    [
        fixed.total(geometry.upper, direction, load),
        per_pretension.total(geometry.upper, direction, &Load::none()),
    ]
}

/// Sums over the tendons, with φ = f/l the force density.
struct Sums<T> {
    /// Σ (k − φ)aaᵀ: K₁ and the part of K₂ that has its shape.
    along: Symmetric3<T>,
    /// Σ φe_xb_x, Σ φe_yb_y.
    diagonal: [T; 2],
    /// Σ φ(e_xb_y + e_yb_x).
    cross: T,
    /// Σ φe_zb.
    vertical: [T; 2],
    /// Σ φe.
    ends: [T; 3],
}

impl<T: Scalar> Sums<T> {
    #[inline(always)]
    fn new() -> Self {
        let start = T::SUM_START;
        Self {
            along: Symmetric3 {
                xx: start,
                xy: start,
                xz: start,
                yy: start,
                yz: start,
                zz: start,
            },
            diagonal: [start; 2],
            cross: start,
            vertical: [start; 2],
            ends: [start; 3],
        }
    }

    #[inline(always)]
    fn add(&mut self, tendon: &TendonAtPose<T>, base: [T; 2], tension: T, stiffness: T) {
        let density = tension * tendon.inverse_length;
        let axial = stiffness - density;
        let [ax, ay, az] = tendon.moment;
        let (kx, ky, kz) = (axial * ax, axial * ay, axial * az);
        self.along.xx += kx * ax;
        self.along.xy += kx * ay;
        self.along.xz += kx * az;
        self.along.yy += ky * ay;
        self.along.yz += ky * az;
        self.along.zz += kz * az;
        let [ex, ey, ez] = tendon.end.map(|component| density * component);
        self.diagonal[0] += ex * base[0];
        self.diagonal[1] += ey * base[1];
        self.cross += ex * base[1] + ey * base[0];
        self.vertical[0] += ez * base[0];
        self.vertical[1] += ez * base[1];
        self.ends[0] += ex;
        self.ends[1] += ey;
        self.ends[2] += ez;
    }

    /// Σ (k − φ)aaᵀ + Σ φ((e·B)I − eBᵀ) + K_load, symmetrised.
    #[inline(always)]
    fn total(&self, upper: T, direction: &Direction<T>, load: &Load<T>) -> Symmetric3<T> {
        let [x, y] = self.diagonal;
        let z = upper * self.ends[2];
        let upright = z - load.lever * direction.z;
        let lean =
            |axis: T, end: T, vertical: T| T::HALF * (load.lever * axis - upper * end - vertical);
        Symmetric3 {
            xx: self.along.xx + y + upright,
            xy: self.along.xy - T::HALF * self.cross,
            xz: self.along.xz + lean(direction.x, self.ends[0], self.vertical[0]),
            yy: self.along.yy + x + upright,
            yz: self.along.yz + lean(direction.y, self.ends[1], self.vertical[1]),
            zz: self.along.zz + x + y,
        }
    }
}
