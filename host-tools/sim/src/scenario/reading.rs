//! Reading a scenario, each refusal with its place in the text.

use super::{Scenario, Step, refused};
use leg_rig::toml_error::TomlError;
use leg_rig::{gains, renamed_keys};
use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, Deserializer, Error};

pub(super) fn read(text: &str) -> Result<Scenario, TomlError> {
    let mut table = DeTable::parse(text).map_err(serde_refusal)?;
    let notes = renamed_keys::replace(table.get_mut())?;
    let scenario =
        Scenario::deserialize(Deserializer::from(table.clone())).map_err(serde_refusal)?;
    let root = table.get_ref();
    let steps = root.get("steps");
    let given = steps.and_then(|steps| steps.get_ref().as_array());
    let given = given.map_or(&[][..], |given| &given[..]);
    if given.is_empty() {
        return Err(refused("there is no step".into(), steps.map(Spanned::span)));
    }
    Ok(Scenario {
        steps: given.iter().map(Step::read).collect::<Result<_, _>>()?,
        control: gains::read(root)?,
        notes,
        ..scenario
    })
}

/// What serde refuses, at its place.
fn serde_refusal(error: Error) -> TomlError {
    refused(error.message().into(), error.span())
}

#[cfg(test)]
mod tests {
    use super::super::Scenario;

    fn refusal(text: &str) -> String {
        match Scenario::parse("a.toml", &format!("title = \"\"\n{text}")) {
            Ok(_) => String::new(),
            Err(failure) => failure.render(false),
        }
    }

    #[test]
    fn a_number_that_no_leg_can_meet_is_refused_at_its_place() {
        for (text, sentence, place) in [
            ("steps = []", "there is no step", "2:9"),
            (
                "steps = 3",
                "invalid type: integer `3`, expected a sequence",
                "2:9",
            ),
            (
                "steps = [\"\"]",
                "unknown variant ``, expected one of `arm`, `home`",
                "2:10",
            ),
            (
                "steps = [{ wait_s = \"x\" }]",
                "invalid type: string \"x\", expected a number",
                "2:21",
            ),
            (
                "steps = [\"arm\", { payload = { kg = nan } }]",
                "kg = NaN is not from 0 to 50",
                "2:36",
            ),
            (
                "steps = [\n    { payload = { kg = -5 } },\n]",
                "kg = -5 is not from 0 to 50",
                "3:24",
            ),
            (
                "steps = [{ wait_s = nan }]",
                "wait_s = NaN is not from 0 to 600",
                "2:21",
            ),
            (
                "steps = [{ push = { azimuth_deg = 0, force_n = inf, for_s = 1 } }]",
                "force_n = inf is not from",
                "2:48",
            ),
            (
                "steps = [{ turn = { motor = 1, turns = 1e4 } }]",
                "turns = 10000 is not from -1000 to 1000",
                "2:40",
            ),
            (
                "steps = [{ pretension_n = inf }]",
                "pretension_n = inf is not from",
                "2:27",
            ),
            (
                "steps = [{ measure = { name = \"a\", quantity = \"pretension_n\", between = [2, 1] } }]",
                "between = [2, 1] ends below its start",
                "2:73",
            ),
            (
                "steps = [{ garbage = 4294967295 }]",
                "garbage = 4294967295 is not from 0 to 100000",
                "2:22",
            ),
            (
                "steps = [\"arm\"]\n[start.slack]\nslack_mm = -50",
                "slack_mm = -50 is not from 0 to 50",
                "4:12",
            ),
            (
                "steps = [\"arm\"]\n[plant]\ncell_gain_error_percent = [1e6, 0, 0]",
                "cell_gain_error_percent = 1000000 is not from -50 to 50",
                "4:27",
            ),
        ] {
            let message = refusal(text);
            assert!(message.contains(sentence), "{text}: {message}");
            assert!(
                message.contains(&format!("a.toml:{place}")),
                "{text}: {message}"
            );
            assert!(message.contains("help: "), "{text}: {message}");
        }
        assert_eq!(refusal("steps = [\"arm\"]"), "");
    }

    #[test]
    fn a_text_that_is_no_short_line_is_refused_at_its_place() {
        let steps = "steps = [{ measure = { name = \"NAME\", quantity = \"pretension_n\", between = [1, 2] } }]";
        let file = |title: &str, name: &str| {
            format!("title = \"{title}\"\n{}", steps.replace("NAME", name))
        };
        let (title, name) = ("ä".repeat(200), "ä".repeat(100));
        assert!(Scenario::parse("a.toml", &file(&title, &name)).is_ok());
        for (text, sentence, place) in [
            (
                file(&[&title, "x"].concat(), "x"),
                "title has more than 200 letters",
                "1:9",
            ),
            (
                file("x", &[&name, "x"].concat()),
                "name has more than 100 letters",
                "2:31",
            ),
            (
                file("a\\u001b[2J", "x"),
                "title is not one line of plain letters",
                "1:9",
            ),
        ] {
            let message = match Scenario::parse("a.toml", &text) {
                Ok(_) => String::new(),
                Err(failure) => failure.render(false),
            };
            assert!(message.contains(sentence), "{sentence}: {message}");
            let place = format!("a.toml:{place}");
            assert!(message.contains(&place), "{place}: {message}");
        }
    }

    #[test]
    fn old_keys_are_read_with_a_note() {
        let text = "title = \"\"\nsteps = [{ level_n = 60 }, { measure = { name = \"a\", quantity = \"level_n\", between = [1, 2] } }]\n[start.held]\nazimuth_deg = 0\ntilt_deg = 0\nlevel_n = 70\npayload_kg = 0\n";
        let old = Scenario::parse("old.toml", text);
        let new = Scenario::parse("new.toml", &text.replace("level_n", "pretension_n"));
        assert_eq!(old.as_ref().map(|old| old.notes.len()), Ok(2));
        let old = old.map(|old| Scenario {
            notes: Vec::new(),
            ..old
        });
        assert_eq!(old, new);
    }
}
