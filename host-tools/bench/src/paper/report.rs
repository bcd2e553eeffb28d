//! The report: what is published beside what is computed, in Markdown.

use super::row::{PaperRow, PublishedAs, Topic};
use super::{Erratum, Paper};
use std::path::{Path, PathBuf};

const INTRODUCTION: &str = "\
# The paper's numbers beside ours

Ma, Yu, Dong, Axinte, \"Design and stiffness analysis of a class of 2-DoF tendon driven parallel kinematics mechanism\".
Every number in the columns \"ours\" and \"difference\" was computed when this report was written, on the rig of Table 1
with the leg's mass from the note in Fig. 9, at a pretension of 70 N.

";

const NOT_COMPARED: &str = "\
## What the paper does not report

Figure 9 (b) shows the error of theory against experiment; ours beside it shows the linear model against the nonlinear
equilibrium. The slope of the stiffness over the tension and the pretension of the experiment cannot be told apart from
what is printed: the default curve's choice is stated in its rig file.

";

/// The whole report; figures are named relative to its directory.
#[must_use]
pub fn markdown(paper: &Paper, figures: &[(PathBuf, &'static str)]) -> String {
    let topics = Topic::ALL.map(|topic| table(topic, paper));
    [
        INTRODUCTION.to_owned(),
        summary(paper),
        topics.concat(),
        format!(
            "## Entries of Eqs. (24) and (25)\n\n{}",
            rows(paper.entries.iter())
        ),
        errata(&paper.errata),
        pictures(figures),
        NOT_COMPARED.to_owned(),
    ]
    .concat()
}

fn summary(paper: &Paper) -> String {
    let differing = paper
        .rows
        .iter()
        .filter(|row| row.verdict() == super::Verdict::Differs);
    let list: String = differing
        .map(|row| {
            format!(
                "- {} ({} {}): {}.\n",
                row.what,
                number(row, row.ours),
                row.unit,
                row.why
            )
        })
        .collect();
    format!("## What does not agree\n\n{list}\n")
}

fn table(topic: Topic, paper: &Paper) -> String {
    let of_topic = paper.rows.iter().filter(|row| row.topic == topic);
    format!("## {}\n\n{}", topic.heading(), rows(of_topic))
}

fn rows<'a>(rows: impl Iterator<Item = &'a PaperRow>) -> String {
    let rows: String = rows
        .map(|row| {
            let limit = match row.meaning {
                PublishedAs::Value | PublishedAs::Unrepeatable => "",
                PublishedAs::AtMost => "≤ ",
            };
            format!(
                "| {} | {limit}{} | {} | {:+.*} | {} | {} | {} | {} |\n",
                row.what,
                number(row, row.published),
                number(row, row.ours),
                row.decimals,
                row.difference(),
                number(row, row.bound),
                row.unit,
                row.verdict().word(),
                row.why
            )
        })
        .collect();
    format!(
        "| what | published | ours | difference | bound | unit | verdict | why |\n|---|---|---|---|---|---|---|---|\n{rows}\n"
    )
}

fn number(row: &PaperRow, value: f64) -> String {
    format!("{value:.*}", row.decimals)
}

fn errata(errata: &[Erratum]) -> String {
    let place = match errata.first() {
        Some(_) => "at azimuth 30°, tilt 30° with 2 kg where a pose is needed",
        None => return String::new(),
    };
    let rows: String = errata
        .iter()
        .map(|erratum| {
            format!(
                "| {} | {} | {} | {} | {:.6} | {:.6} | {} |\n",
                erratum.place,
                erratum.wrong,
                erratum.right,
                erratum.number,
                erratum.printed,
                erratum.corrected,
                erratum.unit
            )
        })
        .collect();
    format!(
        "## Errors of the print\n\nEach is shown by a number, {place}.\n\n\
         | where | wrong | right | number | as printed | corrected | unit |\n|---|---|---|---|---|---|---|\n{rows}\n"
    )
}

fn pictures(figures: &[(PathBuf, &'static str)]) -> String {
    let name = |path: &Path| {
        path.file_name()
            .map(|name| name.to_string_lossy().into_owned())
    };
    let pictures: String = figures
        .iter()
        .filter_map(|(path, caption)| {
            Some(format!("![{caption}]({})\n\n{caption}.\n\n", name(path)?))
        })
        .collect();
    format!("## Figures\n\n{pictures}")
}
