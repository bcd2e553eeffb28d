//! What `leg strikes` prints.

use leg_bench::strikes::{
    Alarm, Moment, StrikeRow, StrikeSummary, Struck, UseResult, WorstByBar, WorstStrike,
};

const HEADING: &str = "\
fault                        state         strikes     highest tension          tip moved      named        after  first fault                  driven after  failed\n";

pub(super) fn table(rows: &[StrikeRow], summary: &StrikeSummary, seed: u64) -> String {
    let lines: String = rows.iter().map(row).collect();
    format!("{}{HEADING}{lines}", heading(summary, seed))
}

fn heading(summary: &StrikeSummary, seed: u64) -> String {
    let left = summary.left_shadow.len();
    format!(
        "{} strikes at seed {seed}, {} failed, {left} left their shadow in f64\n\n",
        summary.strikes, summary.failed
    )
}

const BARS_HEADING: &str = "\
fault                        state         strikes       tension / bar         homing / bar            tip / bar          named / bar\n";

/// The worst of each measure beside its bar.
pub(super) fn bar_report(rows: &[StrikeRow], summary: &StrikeSummary, seed: u64) -> String {
    let line = |row: &StrikeRow| {
        let measures = row.by_bars;
        format!(
            "{:27}  {:12}  {:7}  {}  {}  {}  {}\n",
            row.fault,
            row.state.name(),
            row.count,
            value_and_bar(measures.tension_n, 1, "N"),
            value_and_bar(measures.homing_n, 1, "N"),
            value_and_bar(measures.tip_mm, 2, "mm"),
            value_and_bar(measures.named_s, 3, "s"),
        )
    };
    let lines: String = rows.iter().map(line).collect();
    let failed: String = rows.iter().filter_map(failed_line).collect();
    format!("{}{BARS_HEADING}{lines}{failed}", heading(summary, seed))
}

/// What failed by a fault in a state, if anything did.
fn failed_line(row: &StrikeRow) -> Option<String> {
    let (index, why) = row.first_failed.as_ref()?;
    Some(format!(
        "{} {}: {} FAIL, first #{index}: {why}\n",
        row.fault,
        row.state.name(),
        row.failed
    ))
}

fn value_and_bar(measure: WorstByBar, digits: usize, unit: &str) -> String {
    if measure.value == 0.0 {
        return format!("{:>19}", "-");
    }
    let WorstByBar { value, bar, .. } = measure;
    format!(
        "{:>19}",
        format!("{value:.digits$} / {bar:.digits$} {unit}")
    )
}

fn row(row: &StrikeRow) -> String {
    let mut names: Vec<_> = row.names.iter().collect();
    names.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
    let name = match names.as_slice() {
        [] => "-".into(),
        [(name, _)] => (*name).to_string(),
        [(name, _), others @ ..] => format!("{name}, {} others", others.len()),
    };
    let tension = if row.homing_n.value > 0.0 {
        row.homing_n
    } else {
        row.tension_n
    };
    let failed = match &row.first_failed {
        None => "pass".into(),
        Some((index, why)) => format!("{} FAIL, first #{index}: {why}", row.failed),
    };
    format!(
        "{:27}  {:12}  {:7}  {}  {}  {:6}  {}  {name:38}  {}  {failed}\n",
        row.fault,
        row.state.name(),
        row.count,
        worst(tension, 1, "N"),
        worst(row.tip_mm, 2, "mm"),
        row.named,
        worst(row.named_s, 2, "s"),
        worst(row.driven_s, 2, "s"),
    )
}

/// A measure and the strike that had it.
fn worst(worst: WorstStrike, digits: usize, unit: &str) -> String {
    if worst.value == 0.0 {
        return format!("{:>18}", "-");
    }
    format!(
        "{:>18}",
        format!("{:.digits$} {unit} #{}", worst.value, worst.index)
    )
}

pub(super) fn course(struck: &Struck, course: &[Moment]) -> String {
    let lines: String = course.iter().map(moment).collect();
    let named = match (struck.named, struck.named_s) {
        (Some(name), Some(after_s)) => format!("{name} after {after_s:.3} s"),
        _ => "no fault".into(),
    };
    let shadow = if struck.left_shadow {
        "; left its shadow in f64"
    } else {
        ""
    };
    let verdict = if struck.passes() {
        "pass".into()
    } else {
        format!("FAIL: {}", struck.failures.join(", "))
    };
    format!(
        "#{}: {} of tendon {}\n{}\n\n\
         time s     tip mm    true tensions N          measured N               duties                    state, faults\n{lines}\n\
         {named}; highest tension {:.1} N; tip {:.2} mm{shadow}\n{verdict}\n",
        struck.index, struck.fault, struck.tendon, struck.case, struck.tension_n, struck.tip_mm,
    )
}

fn moment(moment: &Moment) -> String {
    let three = |values: [f64; 3], digits: usize| {
        values.map(|value| format!("{value:7.digits$}")).join(" ")
    };
    format!(
        "{:6.3}  {:9.3}  {}  {}  {}   {}, {}\n",
        moment.time_s,
        moment.tip_mm,
        three(moment.tensions_n, 1),
        three(moment.measured_n.map(f64::from), 1),
        three(moment.duty.map(f64::from), 3),
        moment.state,
        moment.faults,
    )
}

/// A line for each rig, and one for each alarm.
pub(super) fn usages(usages: &[UseResult]) -> String {
    let mut names: Vec<&str> = usages.iter().map(|usage| usage.rig.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let rigs: String = names
        .into_iter()
        .map(|name| rig_summary(name, usages))
        .collect();
    let alarms = usages.iter().flat_map(|usage| {
        let stopped = usage
            .stopped
            .iter()
            .map(|why| format!("{}, part {}: {why}\n", usage.rig, usage.part));
        stopped.chain(usage.alarms.iter().map(|one| alarm(usage, one)))
    });
    let alarms: String = alarms.collect();
    format!("rig                        hours    uses  false alarms  true alarms\n{rigs}\n{alarms}")
}

fn rig_summary(name: &str, usages: &[UseResult]) -> String {
    let all = || usages.iter().filter(|usage| usage.rig == name);
    let alarms = || all().flat_map(|usage| &usage.alarms);
    let hours = all().map(|usage| usage.time_s).sum::<f64>() / 3600.0;
    let uses: u64 = all().map(|usage| usage.uses).sum();
    let beyond = alarms().filter(|alarm| alarm.beyond).count();
    let false_ones = alarms().count() - beyond;
    format!("{name:25} {hours:6.2}  {uses:6}  {false_ones:12}  {beyond:11}\n")
}

fn alarm(usage: &UseResult, alarm: &Alarm) -> String {
    let kind = if alarm.beyond { "true" } else { "FALSE" };
    let [low, high] = alarm.tensions_n;
    format!(
        "{kind} alarm on {}, part {}, {:.2} s: {}; true tensions {low:.1} to {high:.1} N; {}\n",
        usage.rig, usage.part, alarm.time_s, alarm.fault, alarm.uses
    )
}
