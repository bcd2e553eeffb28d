//! The mechanism by plain vectors in f64: Eqs. (3–7) as they stand, with none of the model's short cuts.

use leg_model::RigParameters;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// [v×] (Eq. 16).
#[must_use]
pub fn skew(v: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -v.z, v.y, v.z, 0.0, -v.x, -v.y, v.x, 0.0)
}

/// Rotation about a unit `axis` by `angle` rad, after Rodrigues.
#[must_use]
pub fn rodrigues(axis: &Vector3<f64>, angle: f64) -> Matrix3<f64> {
    let k = skew(axis);
    Matrix3::identity() + k * angle.sin() + k * k * (1.0 - angle.cos())
}

/// Rotation by the rotation vector `psi`, rad.
#[must_use]
pub fn turn(psi: &Vector3<f64>) -> Matrix3<f64> {
    let angle = psi.norm();
    if angle == 0.0 {
        return Matrix3::identity();
    }
    rodrigues(&(psi / angle), angle)
}

/// R = Rod((sin φ, −cos φ, 0), θ)·Rz(τ) of azimuth φ, tilt θ and torsion τ, rad.
#[must_use]
pub fn rotation(azimuth: f64, tilt: f64, torsion: f64) -> Matrix3<f64> {
    let axis = Vector3::new(azimuth.sin(), -azimuth.cos(), 0.0);
    rodrigues(&axis, tilt) * rodrigues(&Vector3::z(), torsion)
}

/// The tendons at one rotation of the leg.
#[derive(Clone, Copy, Debug)]
pub struct Tendons<const N: usize> {
    /// e: their lower ends, m.
    pub ends: [Vector3<f64>; N],
    /// n: unit vectors from the lower to the upper ends.
    pub pulls: [Vector3<f64>; N],
    /// m.
    pub lengths: SVector<f64, N>,
}

impl<const N: usize> Tendons<N> {
    /// Turns the leg of a mechanism.
    #[must_use]
    pub fn new(parameters: &RigParameters<f64, N>, rotation: &Matrix3<f64>) -> Self {
        let p = parameters;
        let plate = |[x, y]: [f64; 2], z| Vector3::new(x, y, z);
        let ends = p
            .leg_anchors_m
            .map(|s| rotation * plate(s, -p.joint_length_m));
        let spans: [Vector3<f64>; N] =
            std::array::from_fn(|i| plate(p.base_anchors_m[i], p.upper_length_m) - ends[i]);
        Self {
            ends,
            pulls: spans.map(|span| span.normalize()),
            lengths: SVector::from_fn(|i, _| spans[i].norm()),
        }
    }

    /// A = [e × n], m.
    #[must_use]
    pub fn moment_map(&self) -> SMatrix<f64, 3, N> {
        SMatrix::from_fn(|row, i| self.ends[i].cross(&self.pulls[i])[row])
    }
}

/// Energy of the leg and its payload in the field of gravity, J.
#[must_use]
pub fn potential<const N: usize>(
    parameters: &RigParameters<f64, N>,
    rotation: &Matrix3<f64>,
    payload_kg: f64,
) -> f64 {
    let p = parameters;
    let height = |below: f64| (rotation * Vector3::new(0.0, 0.0, -below)).z;
    let tip = p.joint_length_m + p.leg_length_m;
    p.gravity_m_per_s2 * (p.leg_mass_kg * height(p.leg_centroid_m) + payload_kg * height(tip))
}

/// Moment of the weights about the joint centre, N·m: lever × weight.
#[must_use]
pub fn load_moment<const N: usize>(
    parameters: &RigParameters<f64, N>,
    rotation: &Matrix3<f64>,
    payload_kg: f64,
) -> Vector3<f64> {
    let p = parameters;
    let moment = |below: f64, mass: f64| {
        let lever = rotation * Vector3::new(0.0, 0.0, -below);
        lever.cross(&Vector3::new(0.0, 0.0, -mass * p.gravity_m_per_s2))
    };
    moment(p.leg_centroid_m, p.leg_mass_kg) + moment(p.joint_length_m + p.leg_length_m, payload_kg)
}

/// Azimuths and tilts, rad: every `step_deg` round the vertical, and from `step_deg` to `tilt_max_deg`.
pub fn poses(tilt_max_deg: u32, step_deg: u32) -> impl Iterator<Item = (f64, f64)> {
    let steps =
        move |end: u32| (1..=end / step_deg).map(move |i| f64::from(i * step_deg).to_radians());
    steps(tilt_max_deg).flat_map(move |tilt| steps(360).map(move |azimuth| (azimuth, tilt)))
}
