//! The method of `leg bode` on a loop that is known, a sample of it, and that its bars can fail.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_bench::bode::{
    BodeCampaign, ClosedLoop, Excitation, Feedback, Margin, MarginRow, Margins, Sides, Sweep,
    Swept, WorstMargin, rows,
};
use leg_boards::image::workspace_root;
use leg_firmware::settings::Servo;
use leg_rig::rig_file::RigFile;
use std::{env, fs};

/// An integrator of a gain with two ticks of delay, in a closed loop: L(z) = k z⁻²/(1 − z⁻¹), |L| = k/(2 sin(Ω/2)),
/// arg L = −90° − 1.5 Ω.
#[derive(Clone)]
struct Integrator {
    gain: f64,
    sum: f64,
    delayed: [f64; 2],
    /// A constant that is no part of the loop.
    offset: f64,
}

impl ClosedLoop for Integrator {
    fn tick(&mut self, added: f64) -> Result<Sides, String> {
        self.sum += self.delayed[1];
        let returned = -self.gain * self.sum + self.offset;
        let injected = returned + added;
        self.delayed = [injected, self.delayed[0]];
        Ok(Sides { returned, injected })
    }
}

/// A loop that ends when more than so much is added.
#[derive(Clone)]
struct Limited(f64);

impl ClosedLoop for Limited {
    fn tick(&mut self, added: f64) -> Result<Sides, String> {
        if added.abs() > self.0 {
            return Err("too much is added".into());
        }
        Ok(Sides {
            returned: 0.0,
            injected: added,
        })
    }
}

/// Where the whole amplitude ends the run a half, a quarter and an eighth are tried; what even that ends is named.
#[test]
fn a_point_is_measured_with_as_much_as_the_loop_bears() {
    let excitation = Excitation {
        tick_hz: 8000.0,
        amplitude: 1.0,
        settle_s: 0.1,
        settle_periods: 1.0,
        window_s: 0.1,
        window_periods: 1.0,
    };
    let part = |most: f64| Ok::<_, String>(excitation.measure(&Limited(most), 40.0)?.part);
    assert_eq!(part(1.1), Ok(1.0));
    assert_eq!(part(0.9), Ok(0.5));
    assert_eq!(part(0.3), Ok(0.25));
    assert_eq!(part(0.2), Ok(0.125));
    let ended = part(0.1).unwrap_err();
    assert!(ended.contains("not measured at 40.00 Hz") && ended.contains("too much is added"));
}

#[test]
fn the_margins_of_a_known_loop_are_found() {
    for gain in [0.1_f64, 0.3, 0.5, 0.8] {
        let closed = Integrator {
            gain,
            sum: 0.0,
            delayed: [0.0; 2],
            offset: 3.0,
        };
        let sweep = Sweep {
            excitation: Excitation {
                tick_hz: 8000.0,
                amplitude: 1.0,
                settle_s: 0.1,
                settle_periods: 4.0,
                window_s: 0.05,
                window_periods: 3.0,
            },
            from_hz: 40.0,
            to_hz: 3000.0,
            points: 20,
        };
        let points = sweep.run(&closed).unwrap();
        let hertz = |omega: f64| omega * 8000.0 / std::f64::consts::TAU;
        for point in &points {
            let omega = point.hz / hertz(1.0);
            let gain_db = 20.0 * (gain / (2.0 * (0.5 * omega).sin())).log10();
            let phase_deg = -90.0 - 1.5 * omega.to_degrees();
            assert!(
                (point.gain_db - gain_db).abs() < 0.05,
                "{point:?} {gain_db}"
            );
            let off = (point.phase_deg - phase_deg + 180.0).rem_euclid(360.0) - 180.0;
            assert!(off.abs() < 0.3, "{point:?} {phase_deg}");
        }
        let found = Margins::new(&points);
        let crossover = 2.0 * (0.5 * gain).asin();
        let expected = [-20.0 * gain.log10(), 90.0 - 1.5 * crossover.to_degrees()];
        assert!(
            (found.gain_db.unwrap() - expected[0]).abs() < 0.2,
            "{found:?}"
        );
        assert!(
            (found.phase_deg.unwrap() - expected[1]).abs() < 1.0,
            "{found:?}"
        );
        let at = hertz(std::f64::consts::FRAC_PI_3);
        assert!(
            (found.gain_hz.unwrap() / at - 1.0).abs() < 0.02,
            "{found:?}"
        );
        assert!((found.phase_hz.unwrap() / hertz(crossover) - 1.0).abs() < 0.02);
    }
}

/// Measures the paper's rig with settings of its own in the states of some numbers.
fn measured(
    set: impl Fn(&mut Servo),
    seed: u64,
    numbers: &[u64],
    loops: &[Feedback],
) -> Vec<Swept> {
    println!("seed {seed}, {numbers:?}");
    let mut file = RigFile::load(None).unwrap();
    file.gains.servos.iter_mut().for_each(set);
    let campaign = BodeCampaign {
        seed,
        rigs: vec![("table1".into(), file)],
        loops: loops.to_vec(),
    };
    let states = numbers.iter();
    let swept = states.flat_map(|&number| campaign.run(number..number + 1, || ()));
    let swept: Vec<Swept> = swept.collect();
    let ended = swept.iter().filter_map(|one| one.failure.as_ref());
    assert_eq!(ended.collect::<Vec<_>>(), Vec::<&String>::new());
    swept
}

/// The worst margin of a loop at any amplitude; none where it has none.
fn worst(rows: &[MarginRow], feedback: Feedback, margin: Margin) -> Option<&WorstMargin> {
    let rows = rows
        .iter()
        .filter(|row| row.feedback == feedback && row.margin == margin);
    rows.filter_map(|row| row.worst.as_ref())
        .min_by(|a, b| a.value.total_cmp(&b.value))
}

/// The lines of a page between its marks for the worst margins.
fn page_rows(rows: &[MarginRow]) -> String {
    let line = |feedback: Feedback| {
        let cell = |margin| {
            let Some(worst) = worst(rows, feedback, margin) else {
                return "none".into();
            };
            let value = match margin {
                Margin::Gain => format!("{:.1} dB", worst.value),
                Margin::Phase => format!("{:.0}°", worst.value),
            };
            let state = &worst.state;
            let (number, kg, tilt_deg) = (state.number, state.payload_kg, state.pose_deg[1]);
            format!(
                "{value} at {:.1} Hz (state {number}: {kg:.1} kg, {tilt_deg:.0}°)",
                worst.hz
            )
        };
        let [gain, phase] = Margin::ALL.map(cell);
        format!("| {} | {gain} | {phase} |\n", feedback.name())
    };
    let lines: String = Feedback::ALL.into_iter().map(line).collect();
    format!("| loop | gain margin | phase margin |\n|---|---|---|\n{lines}")
}

/// All loops of the paper's rig meet the bars in those of the twelve states of `leg bode` in which one of them has its least margin, and
/// the page says so. `LEG_OVERWRITE=1` writes its table anew.
#[test]
fn the_loops_keep_their_margins() {
    let swept = measured(|_| (), 1, &[2, 4, 5, 7], &Feedback::ALL);
    let rows = rows(&swept);
    for feedback in Feedback::ALL {
        let of_loop = || swept.iter().filter(|one| one.feedback == feedback);
        assert!(of_loop().count() >= 4, "{feedback:?} is not measured");
        let failed: Vec<_> = of_loop().filter(|one| !one.passes()).collect();
        assert!(failed.is_empty(), "{failed:?}: {rows:?}");
        // One whose margins were not found fails.
        let not_found = of_loop().map(|one| Swept {
            margins: Margins::new(&[]),
            ..one.clone()
        });
        assert!(not_found.into_iter().all(|one| !one.passes()));
    }
    let path = workspace_root().join("host-tools/docs/scenarios.md");
    let page = fs::read_to_string(&path).unwrap();
    let (before, rest) = page.split_once("<!-- loops -->\n").unwrap();
    let (_, after) = rest.split_once("<!-- end -->").unwrap();
    let table = page_rows(&rows);
    let made = format!("{before}<!-- loops -->\n{table}<!-- end -->{after}");
    if env::var_os("LEG_OVERWRITE").is_some() {
        fs::write(&path, &made).unwrap();
    }
    assert!(
        page == made || env::var_os("LEG_OVERWRITE").is_some(),
        "make the table anew with LEG_OVERWRITE=1:\n{table}"
    );
}

/// The play of the gears takes nothing of the servo: its goal crosses the play with the direction that is asked for. While it followed the
/// motor there, the servo had 7 dB and 18° less. It has 12.0 dB and 53° without play.
#[test]
fn play_takes_no_margin_of_the_servo() {
    let margins = |set: fn(&mut Servo)| {
        let rows = rows(&measured(set, 7, &[0], &[Feedback::Servo]));
        Margin::ALL.map(|margin| worst(&rows, Feedback::Servo, margin).unwrap().value)
    };
    let [with, without] = [margins(|_| ()), margins(|servo| servo.play_m = 0.0)];
    println!("{with:?} {without:?}");
    assert!((10.5..14.0).contains(&without[0]) && (48.0..60.0).contains(&without[1]));
    assert!(with[0] > without[0] - 2.0 && with[1] > without[1] - 6.0);
}

/// A loop whose gain is raised by a setting is below the bars, and it alone is named.
#[test]
fn a_loop_with_too_much_gain_is_named() {
    let set = |servo: &mut Servo| {
        servo.play_m = 0.0;
        servo.speed_gain_v_s_per_m *= 2.5;
    };
    let rows = rows(&measured(set, 7, &[0], &[Feedback::Servo, Feedback::Trim]));
    let failed = rows.iter().filter(|row| !row.passes());
    let named: Vec<_> = failed.map(|row| row.feedback.name()).collect();
    assert!(
        !named.is_empty() && named.iter().all(|name| *name == "servo"),
        "{named:?}"
    );
}
