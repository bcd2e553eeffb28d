//! Where a leg is led, and how stiff it is made.

use leg_firmware::command::Command;

/// Where a leg is led, and how stiff it is made; by default it comes to rest where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Goal {
    /// As it is if there is none.
    pub tensioning: Option<Tensioning>,
    /// Its direction, by the horizontal components; where it is if there is none.
    pub direction: Option<[f32; 2]>,
}

/// What the tendons are tensioned to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tensioning {
    /// The pretension, N.
    Pretension(f32),
    /// The bending stiffness: the smallest, or that against a push in a direction of length 1.
    Stiffness {
        /// N·m/rad.
        demand_nm_per_rad: f32,
        /// None for the smallest.
        towards: Option<[f32; 2]>,
    },
}

impl Goal {
    /// A direction, by its horizontal components.
    #[must_use]
    pub const fn direction(x: f32, y: f32) -> Self {
        Self {
            tensioning: None,
            direction: Some([x, y]),
        }
    }

    /// What is commanded for it, in this order: the tensions first, so that the move is planned with them.
    pub(super) fn commands(&self) -> Vec<Command> {
        let tensioning = self.tensioning.map(Command::from);
        let movement = self.direction.map(|[x, y]| Command::Move { x, y });
        let commands: Vec<_> = tensioning.into_iter().chain(movement).collect();
        if commands.is_empty() {
            // Also where the leg is active: it is this host then that holds it, or another that drives it is named.
            return vec![Command::Hold];
        }
        commands
    }
}

impl From<Tensioning> for Command {
    fn from(tensioning: Tensioning) -> Self {
        match tensioning {
            Tensioning::Pretension(n) => Self::Pretension(n),
            Tensioning::Stiffness {
                demand_nm_per_rad,
                towards,
            } => Self::Stiffness {
                demand_nm_per_rad,
                towards,
            },
        }
    }
}
