//! What happens in a scenario: actions, commands, and waits and measurements.

use super::{CommandStep, TestStep};
use crate::action::Action;
use serde::de::value::EnumAccessDeserializer;
use serde::de::{DeserializeSeed, EnumAccess, Error, IntoDeserializer, VariantAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;

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

/// All names of steps, for messages.
fn names() -> impl Iterator<Item = &'static str> {
    let names = CommandStep::NAMES.into_iter().chain(Action::NAMES);
    names.chain(TestStep::NAMES)
}

impl<'de> Deserialize<'de> for Step {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_enum("Step", &[], StepVisitor)
    }
}

/// Reads the name of a step, and then the one of the three that has it.
struct StepVisitor;

impl<'de> Visitor<'de> for StepVisitor {
    type Value = Step;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a step")
    }

    fn visit_enum<A: EnumAccess<'de>>(self, access: A) -> Result<Step, A::Error> {
        let (StepName(name), variant) = access.variant()?;
        let step = EnumAccessDeserializer::new(Named { name, variant });
        if Action::NAMES.contains(&name) {
            Action::deserialize(step).map(Step::Action)
        } else if CommandStep::NAMES.contains(&name) {
            CommandStep::deserialize(step).map(Step::Command)
        } else {
            TestStep::deserialize(step).map(Step::Test)
        }
    }
}

/// A name that a step has.
struct StepName(&'static str);

impl<'de> Deserialize<'de> for StepName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let found = String::deserialize(deserializer)?;
        names()
            .find(|name| *name == found)
            .map(Self)
            .ok_or_else(|| {
                let known: Vec<_> = names().map(|name| format!("`{name}`")).collect();
                D::Error::custom(format!(
                    "unknown variant `{found}`, expected one of {}",
                    known.join(", ")
                ))
            })
    }
}

/// A step whose name has been read.
struct Named<V> {
    name: &'static str,
    variant: V,
}

impl<'de, V: VariantAccess<'de>> EnumAccess<'de> for Named<V> {
    type Error = V::Error;
    type Variant = V;

    fn variant_seed<S: DeserializeSeed<'de>>(
        self,
        seed: S,
    ) -> Result<(S::Value, Self::Variant), Self::Error> {
        let name = seed.deserialize(self.name.into_deserializer())?;
        Ok((name, self.variant))
    }
}

#[cfg(test)]
mod tests {
    use super::{Step, names};

    #[test]
    fn every_name_is_that_of_a_step() {
        for name in names() {
            let refusal = serde_json::from_str::<Step>(&format!(r#"{{"{name}":[]}}"#)).err();
            let refusal = refusal.map(|error| error.to_string()).unwrap_or_default();
            assert!(!refusal.contains("unknown variant"), "{refusal}");
        }
    }
}
