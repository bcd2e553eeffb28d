//! A sample of `leg moves`, and that its bars can fail.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::common::unlike::{rig_with_5_degrees_of_play, rigs_with_a_cell_off, unlike_rigs};
use crate::host::tune::MEASURED_STRETCH;
use leg_bench::moves::{MoveCampaign, Moved};
use leg_rig::ready_rigs::{READY_RIGS, ReadyRig};
use leg_rig::rig_file::RigFile;
use std::ops::Range;
use std::sync::LazyLock;

fn rig(name: &str) -> (String, RigFile) {
    (name.into(), RigFile::load(Some(name.as_ref())).unwrap())
}

/// Makes so many moves, each of which there is, at a seed that is printed.
fn made(campaign: &MoveCampaign, numbers: Range<u64>) -> Vec<Moved> {
    let count = numbers.end - numbers.start;
    let names: Vec<&str> = campaign.rigs.iter().map(|rig| rig.0.as_str()).collect();
    println!("seed {}, {numbers:?} of {names:?}", campaign.seed);
    let moved = campaign.run(numbers, || ());
    assert_eq!(moved.len() as u64, count, "some were not made");
    let spare_s = moved
        .iter()
        .map(|moved| moved.drawn.longest_s() - moved.took_s);
    let least_s = spare_s.fold(f64::INFINITY, f64::min);
    println!("all made at least {least_s:.4} s sooner than the limits on their motion allow");
    moved
}

fn require_passed(moved: &[Moved]) {
    let failed = moved.iter().filter(|moved| !moved.passes());
    let failed: Vec<_> = failed
        .map(|moved| (&moved.failures, one_line(moved)))
        .collect();
    assert!(failed.is_empty(), "{failed:#?}");
}

/// Which move it is, in one line.
fn one_line(moved: &Moved) -> String {
    let drawn = &moved.drawn;
    format!(
        "{} {}: {:.2?} to {:.2?} with {:.3} kg at {:.1} N",
        drawn.rig,
        drawn.number,
        drawn.begin_deg,
        drawn.end_deg,
        drawn.payload_kg,
        drawn.pretension_n
    )
}

/// The tip stays on its trajectory and does not swing after it, whatever payload is hung on the leg.
#[test]
fn the_tip_stays_on_its_trajectory() {
    let campaign = MoveCampaign {
        seed: 7,
        rigs: vec![rig("table1")],
        payload_kg: None,
    };
    require_passed(&made(&campaign, 0..60));
}

/// Eight moves of each rig, made once for all that is asserted of them.
fn moves_of_every_rig() -> &'static [Moved] {
    static MOVED: LazyLock<Vec<Moved>> = LazyLock::new(|| {
        let campaign = MoveCampaign {
            seed: 9,
            rigs: READY_RIGS.iter().map(|ready| rig(ready.name)).collect(),
            payload_kg: None,
        };
        made(&campaign, 0..8 * READY_RIGS.len() as u64)
    });
    &MOVED
}

#[test]
fn the_tip_of_every_rig_stays_on_its_trajectory() {
    require_passed(moves_of_every_rig());
}

/// A payload that was hung on a leg may take the last newtons below the maximum tension, to which no target leads: such a leg never set out, wherever it
/// was sent, or it stopped 0.2 mm before a pose that takes them.
#[test]
fn a_leg_that_takes_the_last_newtons_to_be_held_moves() {
    for (seed, payload_kg, number) in [
        (803, Some(2.0), 3),
        (803, Some(2.0), 31),
        (805, Some(2.0), 20),
        (815, None, 31),
        (816, None, 25),
    ] {
        let campaign = MoveCampaign {
            seed,
            rigs: READY_RIGS.iter().map(|ready| rig(ready.name)).collect(),
            payload_kg,
        };
        let moved = made(&campaign, number..number + 1);
        require_passed(&moved);
        let [least_n, greatest_n] = moved[0].tensions_n;
        let [f_min_n, f_max_n] = [rig("table1").1.f_min_n, rig("table1").1.f_max_n];
        // Half a newton for what the tensions are off their target.
        assert!(greatest_n > f_max_n - 4.5, "{greatest_n} N");
        assert!(least_n > 0.5 * f_min_n, "{least_n} N");
    }
}

/// Between poses whose tensions are within their limits for the payload, whatever it is: on the way they swing beyond them by little.
#[test]
fn a_move_keeps_the_tensions_between_minimum_and_maximum() {
    let [f_min_n, f_max_n] = [rig("table1").1.f_min_n, rig("table1").1.f_max_n];
    let (mut below_n, mut above_n) = (0.0_f64, 0.0_f64);
    for moved in moves_of_every_rig() {
        assert_eq!(moved.error, None);
        let [least_n, greatest_n] = moved.tensions_n;
        below_n = below_n.max(f_min_n - least_n);
        above_n = above_n.max(greatest_n - f_max_n);
    }
    println!("{below_n} N below, {above_n} N above");
    assert!(
        below_n < 0.5 && above_n < 0.5,
        "{below_n} N below, {above_n} N above"
    );
}

/// Moves whose payload is hardest to find: by 3° in 0.35 s from straight down at 13 and 16 N, whose mode is slow, with 1.7 kg and with
/// nothing.
#[test]
fn a_soft_leg_that_sets_out_from_straight_down_stays_on_its_trajectory() {
    for (seed, payload_kg, number) in [(35, None, 48), (61, Some(0.0), 30)] {
        let campaign = MoveCampaign {
            seed,
            rigs: vec![rig("table1")],
            payload_kg,
        };
        let moved = made(&campaign, number..number + 1);
        let [drawn] = [&moved[0].drawn];
        assert!(drawn.begin_deg[1] < 0.1 && drawn.pretension_n < 17.0);
        require_passed(&moved);
    }
}

/// Moves after which a tip swung by 0.02 to 0.034 mm, for up to 1.3 s: motors broke away too late and went on beyond their references, or
/// braked what was within the play of their gears.
#[test]
fn the_brake_does_not_swing_a_leg_at_rest() {
    for (seed, payload_kg, number) in [
        (33, None, 40),
        (36, None, 9),
        (99_901, None, 129),
        (81_012, Some(2.0), 126),
    ] {
        let campaign = MoveCampaign {
            seed,
            rigs: vec![rig("table1")],
            payload_kg,
        };
        require_passed(&made(&campaign, number..number + 1));
    }
}

/// A simulated leg that is not what the settings say, and one with 5° of play that is known.
#[test]
fn the_tip_comes_to_rest_on_a_leg_unlike_its_settings() {
    for rig in unlike_rigs().chain([rig_with_5_degrees_of_play()]) {
        let unlike = rig.0.clone();
        let campaign = MoveCampaign {
            seed: 7,
            rigs: vec![rig],
            payload_kg: None,
        };
        let moved = made(&campaign, 0..20);
        let hidden = largest(&unlike, &moved, true);
        for (found, bar) in hidden.into_iter().zip(UNLIKE_HIDDEN) {
            assert!(found < bar, "{unlike}: {hidden:?}");
        }
        let [off_mm, swing_mm, found_s, rest_mm] = largest(&unlike, &moved, false);
        let settled_s = match unlike.as_str() {
            "no play" | "5° of play" => NO_PLAY_SETTLED_S,
            _ => UNLIKE_SETTLED_S,
        };
        assert!(off_mm < UNLIKE_OFF_MM && rest_mm < 0.03);
        assert!(swing_mm < UNLIKE_SWING_MM && found_s < settled_s);
    }
}

/// The bars of a move on a leg unlike its settings: one and a half times those of `leg moves`.
const UNLIKE_OFF_MM: f64 = 0.375;
const UNLIKE_SWING_MM: f64 = 0.15;
const UNLIKE_SETTLED_S: f64 = 0.6;

/// The same of a move from straight down: off, swing, mm, time to rest, s, and off at rest, mm.
const UNLIKE_HIDDEN: [f64; 4] = [0.6, 0.3, 1.2, 0.03];

/// The same for a leg without the play that its settings say, or with 5° that is known: what its motors cross in vain, or not to the end, is
/// corrected slowly at rest.
const NO_PLAY_SETTLED_S: f64 = 0.8;

/// The largest of moves from straight down, or from where the payload shows: off the trajectory and swing, mm, time to rest, s, and off the
/// commanded point at rest, mm.
fn largest(unlike: &str, moved: &[Moved], hidden: bool) -> [f64; 4] {
    let of_these = |moved: &&Moved| (moved.drawn.begin_deg[1] < 2.0) == hidden;
    let mut largest = [0.0_f64; 4];
    let mut count = 0;
    for moved in moved.iter().filter(of_these) {
        assert_eq!(moved.error, None, "{unlike}");
        let found = [moved.off_mm, moved.swing_mm, moved.settled_s, moved.rest_mm];
        largest = std::array::from_fn(|i| largest[i].max(found[i]));
        count += 1;
    }
    println!(
        "{unlike}, hidden {hidden}, {count} moves: off, swing, mm; settled, s; rest, mm: {largest:.3?}"
    );
    assert!(count > 1, "{unlike}: {count} moves, hidden {hidden}");
    largest
}

/// A load cell that is off has the leg rest elsewhere, by no more than 0.6 mm: each move is judged about where it rests.
#[test]
fn the_tip_comes_to_rest_with_a_cell_that_is_off() {
    for rig in rigs_with_a_cell_off() {
        let name = rig.0.clone();
        let campaign = MoveCampaign {
            seed: 7,
            rigs: vec![rig],
            payload_kg: None,
        };
        let moved = made(&campaign, 0..20);
        let moved = judged_about_rest(moved);
        require_unlike_bars(&name, &moved, 0.6);
    }
}

/// The same moves, each off its trajectory but for how it rests off the commanded point.
fn judged_about_rest(mut moved: Vec<Moved>) -> Vec<Moved> {
    for moved in &mut moved {
        moved.off_mm = moved.off_about_rest_mm;
    }
    moved
}

/// The bars of a leg unlike its settings, but that it may rest farther off, mm.
fn require_unlike_bars(name: &str, moved: &[Moved], rest_bar_mm: f64) {
    let [hidden_off_mm, hidden_swing_mm, hidden_settled_s, _] = UNLIKE_HIDDEN;
    for (hidden, bars) in [
        (true, [hidden_off_mm, hidden_swing_mm, hidden_settled_s]),
        (false, [UNLIKE_OFF_MM, UNLIKE_SWING_MM, UNLIKE_SETTLED_S]),
    ] {
        let [found @ .., rest_mm] = largest(name, moved, hidden);
        let kept = found.iter().zip(bars).all(|(&found, bar)| found < bar);
        assert!(kept, "{name}: {found:?} beyond {bars:?}");
        assert!(rest_mm < rest_bar_mm, "{name}: {rest_mm} mm");
    }
}

/// Tendons that stretch by a fifth more or less than their curve says are measured as the leg is tensioned after homing.
#[test]
fn a_leg_with_other_tendons_moves() {
    for curve_error in [0.2, -0.2] {
        for (rigs, moves) in [(&READY_RIGS[..1], 20), (&READY_RIGS[1..], 18)] {
            let unlike = |ready: &ReadyRig| {
                let (name, mut file) = rig(ready.name);
                file.plant.curve_error = curve_error;
                (name, file)
            };
            let campaign = MoveCampaign {
                seed: 7,
                rigs: rigs.iter().map(unlike).collect(),
                payload_kg: None,
            };
            let name = format!("curve {curve_error}, {} rigs", rigs.len());
            require_unlike_bars(&name, &made(&campaign, 0..moves), 0.05);
        }
    }
}

/// With what `leg tune` measures of such tendons, as far off as it may be (`other_tendons_are_measured`), the leg moves within the
/// bars of one that is unlike its settings, and rests within 0.15 mm of the commanded point.
#[test]
fn a_leg_that_knows_its_tendons_moves() {
    let off = MEASURED_STRETCH;
    for (factor, left) in [(1.2, off), (1.2, -off), (0.8, off), (0.8, -off)] {
        let measured = format!("[tendon.measured]\nelongation_factor = {factor}\n");
        let text = [READY_RIGS[0].text, &measured].concat();
        let mut file = RigFile::parse("measured", &text).unwrap();
        file.plant.curve_error = left;
        let name = format!("{factor} of the elongation, {left}");
        let campaign = MoveCampaign {
            seed: 7,
            rigs: vec![(name.clone(), file)],
            payload_kg: None,
        };
        let moved = made(&campaign, 0..20);
        require_unlike_bars(&name, &judged_about_rest(moved), 0.15);
    }
}

/// Without the brake heavy legs swing for longer than the bars allow, and fail by nothing else.
#[test]
fn a_leg_whose_swing_is_not_braked_fails() {
    let text = [READY_RIGS[0].text, "[control.motion]\ndamping_ratio = 0\n"].concat();
    let campaign = MoveCampaign {
        seed: 7,
        rigs: vec![(
            "undamped".into(),
            RigFile::parse("undamped", &text).unwrap(),
        )],
        payload_kg: None,
    };
    let moved = campaign.run(0..20, || ());
    let failures: Vec<_> = moved.iter().flat_map(|moved| &moved.failures).collect();
    assert!(!failures.is_empty());
    let swings = |failure: &&String| failure.starts_with("settled") || failure.starts_with("swing");
    assert!(failures.iter().all(swings), "{failures:?}");
}
