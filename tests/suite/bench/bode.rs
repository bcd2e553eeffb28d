//! A sample of `leg bode`, and that its bars can fail.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_bench::bode::{Campaign, Feedback, Margin, Row, Swept, rows};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;

/// The paper's rig with settings of its own.
fn campaign(settings: &str, seed: u64, loops: &[Feedback]) -> Campaign {
    let text = [READY_RIGS[0].text, settings].concat();
    Campaign {
        seed,
        rigs: vec![("rig".into(), RigFile::parse("rig", &text).unwrap())],
        loops: loops.to_vec(),
    }
}

fn measured(settings: &str, seed: u64, loops: &[Feedback], count: u64) -> Vec<Swept> {
    println!("seed {seed}");
    campaign(settings, seed, loops).run(count, || ())
}

/// The worst margin of a loop at any amplitude; none where it has none.
fn worst(rows: &[Row], feedback: Feedback, margin: Margin) -> Option<f64> {
    let rows = rows.iter().filter(|row| row.feedback == feedback && row.margin == margin);
    rows.filter_map(|row| Some(row.worst.as_ref()?.value)).min_by(f64::total_cmp)
}

/// What the loops of the paper's rig have at a leg that leans by 30° with 1.8 kg, among the worst that there are. The bars of 6 dB and
/// 45° are met by the trim alone: the rest is kept from becoming less. The servo's goal follows its motor inside the play of the gear;
/// the damping meets a mode that is slow on one axis.
#[test]
fn the_loops_keep_the_margins_that_they_have() {
    let rows = rows(&measured("", 3, &Feedback::ALL, 1));
    for (feedback, least_db, least_deg) in [
        (Feedback::Servo, 3.5, 25.0),
        (Feedback::Damping, 4.8, 30.0),
        (Feedback::Tension, 4.5, 17.0),
        (Feedback::Trim, Margin::Gain.bar(), Margin::Phase.bar()),
    ] {
        for (margin, least) in [(Margin::Gain, least_db), (Margin::Phase, least_deg)] {
            let found = worst(&rows, feedback, margin);
            println!("{feedback:?} {margin:?} {found:?}");
            assert!(found.is_none_or(|found| found >= least), "{feedback:?} {margin:?} {found:?}");
        }
    }
    let ended = rows.iter().all(|row| row.measured > 0 && row.worst.as_ref().is_none_or(|worst| worst.hz > 0.0));
    assert!(ended, "{rows:#?}");
}

/// Without the play that its goal follows, the servo has what its transfer function has: 42.5° and 11.6 dB by calculation without
/// friction, which adds a few degrees.
#[test]
fn a_servo_whose_goal_stands_still_has_the_margins_of_its_transfer_function() {
    let swept = measured("[control.servo]\nplay_m = 0\n", 7, &[Feedback::Servo], 4);
    for one in &swept {
        let [gain_db, phase_deg] = Margin::ALL.map(|margin| margin.of(one).unwrap()[0]);
        assert!((10.5..13.5).contains(&gain_db), "{one:?}");
        assert!((42.0..60.0).contains(&phase_deg), "{one:?}");
    }
}

/// A loop whose gain is raised by the rig's settings is below the bars, and it is the one that is named.
#[test]
fn a_loop_with_too_much_gain_is_named() {
    let settings = "[control.servo]\nplay_m = 0\nspeed_gain_v_s_per_m = 5400\n";
    let rows = rows(&measured(settings, 7, &[Feedback::Servo, Feedback::Trim], 1));
    for row in &rows {
        let expected = row.feedback == Feedback::Servo;
        assert_eq!(row.failed > 0, expected, "{row:#?}");
    }
    let named = rows.iter().find(|row| row.failed > 0).unwrap();
    assert_eq!(named.feedback.name(), "servo");
}
