//! What happens in a scenario: actions, commands, and waits and measurements.

use super::{CommandStep, TestStep, refused};
use crate::action::Action;
use leg_rig::toml_error::TomlError;
use serde::Deserialize;
use strum::VariantNames;
use toml::Spanned;
use toml::de::{DeValue, ValueDeserializer};

/// One step. A step that waits or measures takes its time; every other one is done in the same tick.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Something is done to the leg.
    Action(Action),
    /// The host commands the leg.
    Command(CommandStep),
    /// Something is awaited or measured, or done to the host.
    Test(TestStep),
}

impl Step {
    /// Reads an action, a command or a test, by the name of the step.
    pub(super) fn read(value: &Spanned<DeValue<'_>>) -> Result<Self, TomlError> {
        let table = value.get_ref().as_table().filter(|table| table.len() == 1);
        let (name, place, argument) =
            match (table.and_then(|table| table.iter().next()), value.get_ref()) {
                (Some((name, argument)), _) => {
                    (Some(name.get_ref().as_ref()), name.span(), argument.span())
                }
                (None, DeValue::String(name)) => (Some(name.as_ref()), value.span(), value.span()),
                _ => (None, value.span(), value.span()),
            };
        let step = ValueDeserializer::from(value.clone());
        let is_one_of = |names: &[&str]| name.is_some_and(|name| names.contains(&name));
        let read = if is_one_of(Action::VARIANTS) {
            Action::deserialize(step).map(Self::Action)
        } else if is_one_of(CommandStep::VARIANTS) {
            CommandStep::deserialize(step).map(Self::Command)
        } else if let Some(name) = name.filter(|_| !is_one_of(TestStep::VARIANTS)) {
            let known = [CommandStep::VARIANTS, Action::VARIANTS, TestStep::VARIANTS].concat();
            let known = known.join("`, `");
            let sentence = format!("unknown variant `{name}`, expected one of `{known}`");
            return Err(refused(sentence, Some(place)));
        } else {
            TestStep::deserialize(step).map(Self::Test)
        };
        read.map_err(|error| {
            // Where a step has a single number, serde gives the place of the whole step.
            let nearer = error.span().filter(|span| *span != value.span());
            refused(error.message().into(), nearer.or(Some(argument)))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Action, CommandStep, TestStep};
    use serde::de::{DeserializeOwned, IntoDeserializer, value};
    use strum::VariantNames;

    /// What of the names serde takes for no variant.
    fn unknown<T: DeserializeOwned + VariantNames>() -> Vec<&'static str> {
        let is_unknown = |name: &&&'static str| {
            let read = T::deserialize(IntoDeserializer::<value::Error>::into_deserializer(**name));
            read.is_err_and(|error| error.to_string().contains("unknown variant"))
        };
        T::VARIANTS.iter().filter(is_unknown).copied().collect()
    }

    #[test]
    fn every_name_is_that_of_a_step() {
        let unknown = [
            unknown::<Action>(),
            unknown::<CommandStep>(),
            unknown::<TestStep>(),
        ];
        assert_eq!(unknown.concat(), [""; 0]);
    }
}
