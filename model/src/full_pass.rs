//! The fast path's full pass: kinematics, total stiffness, rotation and tip displacement in one walk over the tendons.

use crate::kinematics::{TendonAtPose, require_lengths};
use crate::{
    Direction, Error, FreePlane, Kinematics, Load, Rig, Scalar, Symmetric3, tip_displacement,
};
use nalgebra::{SVector, Vector3};

/// What the full pass computes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FullPass<T, const N: usize> {
    /// Lengths and moments of the tendons.
    pub kinematics: Kinematics<T, N>,
    /// K₁ + exact K₂ + K_load, symmetrised, N·m/rad. At equilibrium the total is symmetric by itself.
    pub stiffness: Symmetric3<T>,
    /// ψ: how the leg gives way under its load, rad.
    pub rotation: Vector3<T>,
    /// How far that takes the tip, m.
    pub tip_displacement: Vector3<T>,
}

/// Tensions and tangent stiffnesses of the tendons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TendonStates<T, const N: usize> {
    /// N.
    pub tensions: SVector<T, N>,
    /// N/m.
    pub stiffnesses: SVector<T, N>,
}

/// Full pass for a ball joint: three free rotations, a 3×3 solve.
///
/// # Errors
/// [`Error::TendonCollapsed`], or [`Error::Unstable`] when the leg would buckle.
#[inline(always)]
pub fn full_pass<T: Scalar, const N: usize>(
    rig: &Rig<T, N>,
    direction: &Direction<T>,
    load: &Load<T>,
    tendons: &TendonStates<T, N>,
) -> Result<FullPass<T, N>, Error> {
    let (kinematics, stiffness) = total_stiffness(rig, direction, load, tendons)?;
    let rotation = stiffness.solve(&load.moment(direction))?;
    let tip_displacement = tip_displacement(&rotation, direction, rig.tip);
    Ok(FullPass {
        kinematics,
        stiffness,
        rotation,
        tip_displacement,
    })
}

/// Full pass for a support with two freedoms: a 2×2 solve in its free plane.
///
/// # Errors
/// As [`full_pass`].
#[inline(always)]
pub fn full_pass_in_plane<T: Scalar, const N: usize>(
    rig: &Rig<T, N>,
    direction: &Direction<T>,
    plane: &FreePlane<T>,
    load: &Load<T>,
    tendons: &TendonStates<T, N>,
) -> Result<FullPass<T, N>, Error> {
    let (kinematics, stiffness) = total_stiffness(rig, direction, load, tendons)?;
    let rotation = plane.solve_symmetric(&stiffness, &load.moment(direction))?;
    let tip_displacement = tip_displacement(&rotation, direction, rig.tip);
    Ok(FullPass {
        kinematics,
        stiffness,
        rotation,
        tip_displacement,
    })
}

#[inline(always)]
fn total_stiffness<T: Scalar, const N: usize>(
    rig: &Rig<T, N>,
    direction: &Direction<T>,
    load: &Load<T>,
    states: &TendonStates<T, N>,
) -> Result<(Kinematics<T, N>, Symmetric3<T>), Error> {
    let geometry = &rig.geometry;
    let q = direction.half_tangent();
    let mut kinematics = Kinematics::zero();
    let mut sums = Sums::zero();
    let mut product = T::one();
    for (i, pair) in geometry.tendons.iter().enumerate() {
        let tendon = TendonAtPose::new(pair, geometry.upper, geometry.joint, &q);
        kinematics.set(i, &tendon);
        product *= tendon.length;
        sums.add(
            &tendon,
            pair.base,
            states.tensions[i],
            states.stiffnesses[i],
        );
    }
    require_lengths(product)?;
    Ok((kinematics, sums.total(geometry.upper, direction, load)))
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
    fn zero() -> Self {
        let zero = T::zero();
        Self {
            along: Symmetric3 {
                xx: zero,
                xy: zero,
                xz: zero,
                yy: zero,
                yz: zero,
                zz: zero,
            },
            diagonal: [zero; 2],
            cross: zero,
            vertical: [zero; 2],
            ends: [zero; 3],
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
        let level = z - load.lever * direction.z;
        let lean =
            |axis: T, end: T, vertical: T| T::HALF * (load.lever * axis - upper * end - vertical);
        Symmetric3 {
            xx: self.along.xx + y + level,
            xy: self.along.xy - T::HALF * self.cross,
            xz: self.along.xz + lean(direction.x, self.ends[0], self.vertical[0]),
            yy: self.along.yy + x + level,
            yz: self.along.yz + lean(direction.y, self.ends[1], self.vertical[1]),
            zz: self.along.zz + x + y,
        }
    }
}
