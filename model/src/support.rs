//! The central support: how it guides the leg, and how its joint resists (Fig. 2).

use crate::range::{COMPLIANCE_MAX, JOINT_STIFFNESS_MAX, check_not_negative};
use crate::{Direction, Error, FreePlane, Quantity, Reason, Scalar, Twist};

/// How the central support guides the leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[cfg_attr(feature = "schema", derive(postcard_schema::Schema))]
pub enum SupportKind {
    /// Two freedoms, the paper's idealisation: the leg tilts without torsion, about axes in the plane normal to the
    /// bisector of the two plates' normals.
    TorsionFree,
    /// Two freedoms: a universal joint, its first axis fixed to the base along x. The leg twists as it points.
    Universal,
    /// Three freedoms: a ball joint, or an elastic pivot. The tendons, and the joint where it is elastic, hold the
    /// torsion.
    Spherical,
    /// Three freedoms: a universal joint of flexures, which are elastic in torsion, too.
    ElasticUniversal,
}

/// How a joint resists its motions: zero for one that does not.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(postcard_schema::Schema))]
pub struct JointStiffness<T> {
    /// Against tilt, about either axis, N·m/rad.
    pub bending_nm_per_rad: T,
    /// Against torsion beyond that which the joint itself gives the leg, N·m/rad.
    pub torsion_nm_per_rad: T,
    /// Of joint and shaft in series along the leg, m/N: 1/K_joint,z + L_shaft/EA.
    pub axial_compliance_m_per_n: T,
}

impl<T: Scalar> JointStiffness<T> {
    /// A joint that turns freely and is rigid along the leg.
    #[must_use]
    pub fn none() -> Self {
        Self {
            bending_nm_per_rad: T::zero(),
            torsion_nm_per_rad: T::zero(),
            axial_compliance_m_per_n: T::zero(),
        }
    }
}

impl<T> JointStiffness<T> {
    /// The same numbers in another type, each by `convert`.
    #[must_use]
    pub fn map<U>(self, mut convert: impl FnMut(T) -> U) -> JointStiffness<U> {
        JointStiffness {
            bending_nm_per_rad: convert(self.bending_nm_per_rad),
            torsion_nm_per_rad: convert(self.torsion_nm_per_rad),
            axial_compliance_m_per_n: convert(self.axial_compliance_m_per_n),
        }
    }
}

/// A central support whose numbers have been validated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Support<T> {
    kind: SupportKind,
    pub(crate) joint: JointStiffness<T>,
}

impl<T: Scalar> From<SupportKind> for Support<T> {
    /// With a joint that does not resist.
    fn from(kind: SupportKind) -> Self {
        Self {
            kind,
            joint: JointStiffness::none(),
        }
    }
}

impl<T: Scalar> Support<T> {
    /// A support with an elastic joint.
    ///
    /// # Errors
    /// A stiffness that is negative, not finite or above 10⁶ N·m/rad, a compliance above 1 m/N; torsion stiffness of a
    /// support that blocks the torsion, and none where only the joint's torsion stiffness distinguishes a universal
    /// joint from a ball.
    pub fn new(kind: SupportKind, joint: JointStiffness<T>) -> Result<Self, Error> {
        let (bending, torsion) = (joint.bending_nm_per_rad, joint.torsion_nm_per_rad);
        check_not_negative(bending, JOINT_STIFFNESS_MAX, Quantity::JointBending)?;
        check_not_negative(torsion, JOINT_STIFFNESS_MAX, Quantity::JointTorsion)?;
        let compliance = joint.axial_compliance_m_per_n;
        check_not_negative(compliance, COMPLIANCE_MAX, Quantity::AxialCompliance)?;
        let refused = |reason| Err(Error::refused(Quantity::JointTorsion, reason));
        match kind {
            SupportKind::TorsionFree | SupportKind::Universal if torsion > T::zero() => {
                refused(Reason::Blocked)
            }
            SupportKind::ElasticUniversal if torsion <= T::zero() => refused(Reason::NotPositive),
            _ => Ok(Self { kind, joint }),
        }
    }

    /// How it guides the leg.
    #[must_use]
    pub fn kind(&self) -> SupportKind {
        self.kind
    }

    /// How its joint resists.
    #[must_use]
    pub fn joint(&self) -> &JointStiffness<T> {
        &self.joint
    }

    /// Whether the leg can twist at a given direction: three freedoms, not two.
    #[must_use]
    pub fn twists(&self) -> bool {
        matches!(
            self.kind,
            SupportKind::Spherical | SupportKind::ElasticUniversal
        )
    }

    /// Whether its joint resists a rotation.
    #[inline(always)]
    pub(crate) fn elastic(&self) -> bool {
        let JointStiffness {
            bending_nm_per_rad: bending,
            torsion_nm_per_rad: torsion,
            ..
        } = self.joint;
        bending > T::zero() || torsion > T::zero()
    }

    /// Whether its axes are those of a universal joint: the leg twists as it points.
    #[must_use]
    pub fn universal(&self) -> bool {
        matches!(
            self.kind,
            SupportKind::Universal | SupportKind::ElasticUniversal
        )
    }

    /// The twist of the leg at a direction when the joint is not twisted elastically.
    #[must_use]
    pub fn twist(&self, direction: &Direction<T>) -> Twist<T> {
        if self.universal() {
            Twist::universal(&direction.half_tangent())
        } else {
            Twist::none()
        }
    }

    /// The rotations that it leaves free; for a support with three freedoms those that tilt the leg.
    #[must_use]
    pub fn plane(&self, direction: &Direction<T>) -> FreePlane<T> {
        if self.universal() {
            FreePlane::universal(direction)
        } else {
            FreePlane::torsion_free(direction)
        }
    }
}
