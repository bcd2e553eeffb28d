//! What the strikes let pass of each fault, as the page of single faults lists it.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_bench::strikes::{Activity, StrikeBars};
use leg_boards::image::workspace_root;
use leg_sim::plant::Defect;
use std::{env, fs};

/// Any maximum tension: the bars are parts of it, N.
const F_MAX_N: f64 = 100.0;

/// The values of all states, each with the states that have it.
fn grouped(values: &[(String, String)]) -> String {
    let mut groups: Vec<(&str, Vec<&str>)> = Vec::new();
    for (state, value) in values {
        match groups.iter_mut().find(|(known, _)| known == value) {
            Some((_, states)) => states.push(state),
            None => groups.push((value, vec![state])),
        }
    }
    if let [(value, _)] = groups[..] {
        return value.into();
    }
    let cells: Vec<String> = groups
        .into_iter()
        .map(|(value, states)| format!("{value} ({})", states.join(", ")))
        .collect();
    cells.join("; ")
}

/// The widest bars of a fault in a state, near the maximum tension or not: tension, tip, time to its name.
fn widest(defect: Defect, activity: Activity) -> [String; 3] {
    let [far, near] = [false, true].map(|near| StrikeBars::widest(defect, activity, F_MAX_N, near));
    let tension = match activity {
        Activity::Homing => format!("{} N", near.homing_n.max(far.homing_n)),
        _ => format!("{:.0} %", near.tension_n.max(far.tension_n) - F_MAX_N),
    };
    // Where the one has none, the other's: it is named where it shows.
    let named = near.named_s.or(far.named_s);
    let by_itself = if far.cut_off {
        " *"
    } else if near.cut_off {
        " **"
    } else {
        ""
    };
    let tension = match activity {
        Activity::Homing => tension,
        _ => tension + by_itself,
    };
    [
        tension,
        format!("{}{by_itself}", near.tip_mm.max(far.tip_mm)),
        named.map_or_else(|| "none".into(), |time_s| format!("{time_s}")),
    ]
}

fn table() -> String {
    let mut table = String::from(
        "| fault | highest tension, above the maximum, or as such | tip, mm | named after, s |\n|---|---|---|---|\n",
    );
    for (number, (name, _)) in Defect::descriptions().enumerate() {
        let defect = Defect::numbered(number, 0).unwrap();
        let states: Vec<_> = (0..Activity::count()).map(Activity::nth).collect();
        let cells = [0, 1, 2].map(|column| {
            let values = states.iter().map(|&state| {
                let [tension, tip, named] = widest(defect, state);
                (
                    state.name().replace('_', " "),
                    [tension, tip, named][column].clone(),
                )
            });
            grouped(&values.collect::<Vec<_>>())
        });
        table += &format!("| `{name}` | {} |\n", cells.join(" | "));
    }
    table
}

/// `LEG_OVERWRITE=1` writes the table anew.
#[test]
fn the_page_of_single_faults_lists_every_bar_of_the_strikes() {
    let path = workspace_root().join("host-tools/docs/fmea.md");
    let page = fs::read_to_string(&path).unwrap();
    let (before, rest) = page.split_once("<!-- bars -->\n").unwrap();
    let (_, after) = rest.split_once("<!-- end -->").unwrap();
    let made = format!("{before}<!-- bars -->\n{}<!-- end -->{after}", table());
    if env::var_os("LEG_OVERWRITE").is_some() {
        fs::write(&path, &made).unwrap();
    } else {
        assert!(
            page == made,
            "make the table anew with LEG_OVERWRITE=1:\n{}",
            table()
        );
    }
}
