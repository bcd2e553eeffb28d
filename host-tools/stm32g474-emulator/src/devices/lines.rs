//! The lines of the interrupts.

use stm32_metapac::metadata::METADATA;

/// The interrupts by their numbers; several peripherals may share one.
#[derive(Clone, Debug)]
pub struct Lines {
    names: Vec<&'static str>,
    /// The numbers and the levels.
    pub levels: Vec<(u16, bool)>,
}

impl Lines {
    /// All lines low.
    pub fn new() -> Self {
        let all = METADATA.interrupts.iter();
        let known = all.filter_map(|one| Some((one.name, u16::try_from(one.number).ok()?)));
        let (names, numbers): (Vec<_>, Vec<_>) = known.unzip();
        Self {
            names,
            levels: numbers.into_iter().map(|number| (number, false)).collect(),
        }
    }

    /// All lines low again.
    pub fn clear(&mut self) {
        for (_, level) in &mut self.levels {
            *level = false;
        }
    }

    /// A peripheral drives the line of an interrupt: high, or not.
    pub fn raise(&mut self, name: &str, level: bool) {
        if !level {
            return;
        }
        let place = self.names.iter().position(|known| *known == name);
        if let Some((_, line)) = place.and_then(|place| self.levels.get_mut(place)) {
            *line = true;
        }
    }
}
