//! The kernels in f64.
//!
//! Where the fast path has a function of its own (the full pass), the reference is put together from the plain ones, so
//! that a slip in a short cut shows, too.

use crate::check::State;
use leg_firmware_bench::kernels::Kernel;
use leg_model::{
    ConstantStiffness, Direction, Distribution, Elasticity, Error, ForwardKinematics, FreePlane,
    Kinematics, Load, Rig, Tendon, TendonStates, TensionBounds, Twist, distribute, estimate_moment,
    forward_kinematics, forward_kinematics_universal, inverse_kinematics, solve3,
    structural_stiffness, tendon_stiffness, tip_displacement,
};
use nalgebra::{Matrix3, Matrix3x2, SVector, Vector3};

/// The arguments of the kernels, prepared as the firmware prepares them.
pub(super) struct Bench {
    azimuth: f64,
    rig: Rig<f64, 3>,
    direction: Direction<f64>,
    start: Direction<f64>,
    plane: FreePlane<f64>,
    load: Load<f64>,
    bounds: TensionBounds<f64>,
    pretension: f64,
    tendon: ConstantStiffness<f64>,
    curve: Tendon<f64>,
    demand: f64,
    kinematics: Kinematics<f64, 3>,
    distribution: Distribution<f64, 3>,
    states: TendonStates<f64, 3>,
    length_errors: Vector3<f64>,
}

impl Bench {
    pub(super) fn new(state: &State) -> Result<Self, Error> {
        let (rig, query) = (Rig::new(&state.rig())?, state.query()?);
        let input = &state.input;
        let direction = Direction::from_angles(query.azimuth_rad, query.tilt_rad)?;
        let (start_azimuth, start_tilt) = (input.start_azimuth_rad, input.start_tilt_rad);
        let plane = FreePlane::torsion_free(&direction);
        let load = Load::new(&rig, query.payload_kg)?;
        let bounds = TensionBounds::new(query.f_min_n, query.f_max_n)?;
        let tendon = ConstantStiffness::new(input.stiffness_n_per_m.into())?;
        let [curve, ..] = state.with_curves().query()?.tendons;
        let kinematics = inverse_kinematics(rig.geometry(), &direction)?;
        let moment = load.moment(&direction);
        let distribution: Distribution<f64, 3> =
            distribute(&kinematics.moment_map, &plane, &moment, &bounds)?;
        Ok(Self {
            azimuth: query.azimuth_rad,
            rig,
            direction,
            start: Direction::from_angles(start_azimuth.into(), start_tilt.into())?,
            plane,
            load,
            bounds,
            pretension: query.pretension_n,
            tendon,
            curve,
            demand: input.demand_nm_per_rad.into(),
            kinematics,
            distribution,
            states: TendonStates::new(
                distribution.tensions(query.pretension_n),
                SVector::repeat(tendon.stiffness_n_per_m()),
            )?,
            length_errors: Vector3::from(input.length_errors_m.map(f64::from)),
        })
    }

    pub(super) fn run(&self, kernel: Kernel) -> Result<Vec<f64>, Error> {
        Ok(match kernel {
            Kernel::SquareRoot => vec![self.azimuth.abs().sqrt()],
            Kernel::SinCos => vec![self.azimuth.sin(), self.azimuth.cos()],
            Kernel::InverseKinematics => of_kinematics(&self.kinematics),
            Kernel::ForwardKinematics => of_found(&self.found()?),
            Kernel::ForwardKinematicsUniversal => of_found(&self.found_universal()?),
            Kernel::Distribution => self.distribution(),
            Kernel::FullPass => self.pass(None)?,
            Kernel::FullPassInPlane => self.pass(Some(&self.plane))?,
            Kernel::TendonCurve => vec![
                self.curve.elongation(self.pretension)?,
                self.curve.stiffness(self.pretension)?,
            ],
            Kernel::InverseStatics => self.inverse_statics()?,
            Kernel::StiffnessCommand => self.stiffness_command()?,
            Kernel::ModelTick => self.tick()?,
        })
    }

    fn found(&self) -> Result<ForwardKinematics<f64>, Error> {
        let lengths = self.kinematics.lengths + self.length_errors;
        forward_kinematics(self.rig.geometry(), &lengths, &self.start)
    }

    fn found_universal(&self) -> Result<ForwardKinematics<f64>, Error> {
        let geometry = self.rig.geometry();
        let twist = Twist::universal(&self.direction.half_tangent());
        let kinematics = inverse_kinematics(&geometry.twisted(&twist), &self.direction)?;
        let lengths = kinematics.lengths + self.length_errors;
        forward_kinematics_universal(geometry, &lengths, &self.start)
    }

    fn distribution(&self) -> Vec<f64> {
        let distribution = &self.distribution;
        let pretensions = [distribution.pretension_min, distribution.pretension_max];
        let (particular, per_pretension) = (&distribution.particular, &distribution.per_pretension);
        let tensions = self.states.tensions();
        [
            particular.as_slice(),
            per_pretension.as_slice(),
            &pretensions,
            tensions.as_slice(),
        ]
        .concat()
    }

    /// The full pass, in a plane or, without one, on a ball joint.
    fn pass(&self, plane: Option<&FreePlane<f64>>) -> Result<Vec<f64>, Error> {
        let sag = self.sag(&self.kinematics, &self.direction, plane)?;
        Ok([of_kinematics(&self.kinematics), sag].concat())
    }

    /// Total stiffness, rotation and tip displacement.
    fn sag(
        &self,
        kinematics: &Kinematics<f64, 3>,
        direction: &Direction<f64>,
        plane: Option<&FreePlane<f64>>,
    ) -> Result<Vec<f64>, Error> {
        let stiffness = self.stiffness(kinematics, direction);
        let moment = self.load.moment(direction);
        let rotation = match plane {
            Some(plane) => plane.solve(&stiffness, &moment)?,
            None => solve3(&stiffness, &moment)?,
        };
        let tip = tip_displacement(&rotation, direction, self.rig.tip_m());
        let upper = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)].map(|entry| stiffness[entry]);
        Ok([&upper, rotation.as_slice(), tip.as_slice()].concat())
    }

    /// K₁ + exact K₂ + K_load, symmetrised.
    fn stiffness(
        &self,
        kinematics: &Kinematics<f64, 3>,
        direction: &Direction<f64>,
    ) -> Matrix3<f64> {
        let (tensions, stiffnesses) = (self.states.tensions(), self.states.stiffnesses());
        let total = tendon_stiffness(&kinematics.moment_map, stiffnesses)
            + structural_stiffness(self.rig.geometry(), direction, tensions)
            + self.load.stiffness(direction);
        (total + total.transpose()) * 0.5
    }

    fn inverse_statics(&self) -> Result<Vec<f64>, Error> {
        let tensions = self.states.tensions();
        let mut numbers = tensions.as_slice().to_vec();
        for (length, &tension) in self.kinematics.lengths.iter().zip(tensions.iter()) {
            numbers.push(length - self.curve.elongation(tension)?);
        }
        Ok(numbers)
    }

    /// By halving, on the eigenvalues of the plain matrix.
    fn stiffness_command(&self) -> Result<Vec<f64>, Error> {
        let distribution = &self.distribution;
        let (mut low, mut high) = (distribution.pretension_min, distribution.pretension_max);
        let (softest, stiffest) = (self.bending_at(low)?, self.bending_at(high)?);
        let [at_lowest, at_highest] = distribution.limits(&self.bounds);
        if self.demand <= softest {
            return Ok(vec![low, softest, at_lowest.tendon.into()]);
        }
        if self.demand >= stiffest {
            return Ok(vec![high, stiffest, at_highest.tendon.into()]);
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.bending_at(middle)? < self.demand {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(vec![low, self.bending_at(low)?, 0.0])
    }

    /// The smallest eigenvalue of PᵀKP with an orthonormal P, each tendon's stiffness at its own tension.
    fn bending_at(&self, pretension: f64) -> Result<f64, Error> {
        let tensions = self.distribution.tensions(pretension);
        let mut stiffnesses = Vector3::zeros();
        for (stiffness, &tension) in stiffnesses.iter_mut().zip(tensions.iter()) {
            *stiffness = self.curve.stiffness(tension)?;
        }
        let total = tendon_stiffness(&self.kinematics.moment_map, &stiffnesses)
            + structural_stiffness(self.rig.geometry(), &self.direction, &tensions)
            + self.load.stiffness(&self.direction);
        let first = self.plane.rotation([1.0, 0.0]).normalize();
        let basis =
            Matrix3x2::from_columns(&[first, self.plane.normal().normalize().cross(&first)]);
        let reduced = basis.transpose() * (total + total.transpose()) * basis * 0.5;
        Ok(reduced.symmetric_eigenvalues().min())
    }

    fn tick(&self) -> Result<Vec<f64>, Error> {
        let found = self.found()?;
        let direction = &found.direction;
        let kinematics = inverse_kinematics(self.rig.geometry(), direction)?;
        let moment = estimate_moment(&kinematics.moment_map, self.states.tensions());
        let plane = FreePlane::torsion_free(direction);
        let distribution: Distribution<f64, 3> =
            distribute(&kinematics.moment_map, &plane, &moment, &self.bounds)?;
        let tensions = distribution.tensions(self.pretension);
        let mut unstretched = kinematics.lengths;
        for (length, &tension) in unstretched.iter_mut().zip(tensions.iter()) {
            *length -= self.tendon.elongation(tension)?;
        }
        Ok([
            of_found(&found),
            moment.as_slice().to_vec(),
            self.sag(&kinematics, direction, None)?,
            tensions.as_slice().to_vec(),
            unstretched.as_slice().to_vec(),
        ]
        .concat())
    }
}

fn of_kinematics(kinematics: &Kinematics<f64, 3>) -> Vec<f64> {
    let (lengths, map) = (&kinematics.lengths, &kinematics.moment_map);
    [lengths.as_slice(), map.as_slice()].concat()
}

fn of_found(found: &ForwardKinematics<f64>) -> Vec<f64> {
    let rest = [found.residual_m, found.steps.into()];
    [found.direction.vector().as_slice(), &rest].concat()
}
