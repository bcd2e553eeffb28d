//! Inverse statics: the loaded tip comes to rest on its target in the nonlinear model, which shares nothing with it but
//! the mechanism.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_firmware::settings::TendonParameters;
use leg_model::{
    Direction, HoldError, Load, Rig, Support, Tendon, TensionBounds, Twist, estimate_load,
    inverse_statics,
};
use leg_model_tools::nonlinear::{Balance, Posture};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use nalgebra::Vector3;

const PAYLOADS_KG: [f64; 4] = [0.0, 0.5, 1.0, 2.0];

/// Every pose of the workspace's grid: azimuth and tilt, rad.
fn poses(tilt_deg: f64) -> impl Iterator<Item = (f64, f64)> {
    (0..24).flat_map(move |azimuth| {
        (0..=6).map(move |tilt| {
            let azimuth = f64::from(azimuth) * 15.0;
            (
                azimuth.to_radians(),
                (tilt_deg * f64::from(tilt) / 6.0).to_radians(),
            )
        })
    })
}

/// A pretension inside the bounds, near the rig's own; none where no pretension is.
fn feasible_pretension(file: &RigFile, azimuth: f64, tilt: f64, payload_kg: f64) -> Option<f64> {
    let query = file.query(azimuth.to_degrees(), tilt.to_degrees(), payload_kg);
    let range = leg_model::evaluate(&file.parameters, &query)
        .unwrap()
        .pretension_range_n;
    let [lowest, highest] = range;
    // A third of the range from its ends, since the twist of a support with three freedoms depends on the pretension.
    (highest - lowest > 1.0).then(|| file.pretension_n.clamp(lowest + 0.3, highest - 0.3))
}

/// Where the leg with a payload rests on tendons of these unstretched lengths, from a little off.
fn rest(
    file: &RigFile,
    unstretched: Vector3<f64>,
    payload_kg: f64,
    near: &Direction<f64>,
) -> (Balance, Posture) {
    let rig = Rig::new(&file.parameters).unwrap();
    let load = Load::new(&rig, payload_kg).unwrap();
    let balance = Balance::new(rig, load, file.support, file.tendons, unstretched);
    let p = near.vector();
    let start = Direction::from_xy(p.x * 0.99, p.y * 0.99).unwrap();
    let posture = balance
        .rest(Posture {
            direction: start,
            torsion: 0.0,
        })
        .unwrap();
    (balance, posture)
}

/// How far the tip is from its target but for the stretch of joint and shaft along the leg, which no tilt can undo.
fn tip_error_m(file: &RigFile, posture: &Posture, target: &Direction<f64>) -> f64 {
    let tip = file.parameters.joint_length_m + file.parameters.leg_length_m;
    (posture.direction.vector() - target.vector()).norm() * tip
}

fn bounds(file: &RigFile) -> TensionBounds<f64> {
    TensionBounds::new(file.f_min_n, file.f_max_n).unwrap()
}

/// What came out over the workspace.
#[derive(Default)]
struct Worst {
    /// The largest error of the tip, m.
    tip_m: f64,
    /// The largest stretch of joint and shaft along the leg, m.
    stretch_m: f64,
    /// Poses that had a pretension, and poses that had none.
    held: usize,
    infeasible: usize,
}

/// Rests the leg everywhere with unstretched lengths from `compensate`.
fn worst(
    file: &RigFile,
    compensate: impl Fn(f64, f64, f64, f64) -> Result<Vector3<f64>, HoldError>,
) -> Worst {
    let mut worst = Worst::default();
    for payload_kg in PAYLOADS_KG {
        for (azimuth, tilt) in poses(file.tilt_deg) {
            let Some(pretension) = feasible_pretension(file, azimuth, tilt, payload_kg) else {
                worst.infeasible += 1;
                continue;
            };
            let target = Direction::from_angles(azimuth, tilt).unwrap();
            let unstretched = compensate(azimuth, tilt, payload_kg, pretension).unwrap();
            let (balance, posture) = rest(file, unstretched, payload_kg, &target);
            worst.tip_m = worst.tip_m.max(tip_error_m(file, &posture, &target));
            let stretch = balance.axial_stretch_m(&posture).unwrap().abs();
            worst.stretch_m = worst.stretch_m.max(stretch);
            worst.held += 1;
        }
    }
    worst
}

fn hold_in_f64(file: &RigFile) -> impl Fn(f64, f64, f64, f64) -> Result<Vector3<f64>, HoldError> {
    let rig = Rig::new(&file.parameters).unwrap();
    let (support, tendons, bounds) = (file.support, file.tendons, bounds(file));
    move |azimuth, tilt, payload_kg, pretension| {
        let target = Direction::from_angles(azimuth, tilt)?;
        let moment = Load::new(&rig, payload_kg)?.moment(&target);
        let held = inverse_statics(
            &rig, &support, &target, &moment, &bounds, &tendons, pretension,
        )?;
        Ok(held.unstretched)
    }
}

fn round(value: f64) -> f32 {
    value as f32
}

fn hold_in_f32(file: &RigFile) -> impl Fn(f64, f64, f64, f64) -> Result<Vector3<f64>, HoldError> {
    let rig = Rig::new(&file.parameters.map(round)).unwrap();
    let support = Support::new(file.support.kind(), file.support.joint().map(round)).unwrap();
    let tendon = |tendon| {
        TendonParameters::from_tendon(tendon, round)
            .validated()
            .unwrap()
    };
    let tendons: [Tendon<f32>; 3] = file.tendons.each_ref().map(tendon);
    let (floor, ceiling) = (round(file.f_min_n), round(file.f_max_n));
    let bounds = TensionBounds::new(floor, ceiling).unwrap();
    move |azimuth, tilt, payload_kg, pretension| {
        let target = Direction::from_angles(round(azimuth), round(tilt))?;
        let moment = Load::new(&rig, round(payload_kg))?.moment(&target);
        let pretension = round(pretension);
        let held = inverse_statics(
            &rig, &support, &target, &moment, &bounds, &tendons, pretension,
        )?;
        Ok(held.unstretched.map(f64::from))
    }
}

#[test]
fn a_known_load_rests_on_target_on_every_support() {
    for ready in READY_RIGS {
        let file = RigFile::parse(ready.name, ready.text).unwrap();
        let f64_worst = worst(&file, hold_in_f64(&file));
        let Worst {
            tip_m,
            stretch_m,
            held,
            infeasible,
        } = f64_worst;
        println!(
            "{}: {tip_m:.1e} m in f64 at {held} poses ({infeasible} have no pretension), beside a stretch of up to {stretch_m:.1e} m along the leg",
            ready.name
        );
        assert!(held > 400, "{}: {held} poses", ready.name);
        assert!(tip_m <= 1e-9, "{}: {tip_m:e} m in f64", ready.name);
        // What is said of it: less than a tenth of a millimetre, and none where the joint is rigid.
        let rigid = file.support.joint().axial_compliance_m_per_n == 0.0;
        assert_eq!(rigid, stretch_m == 0.0, "{}", ready.name);
        assert!(
            stretch_m < 1e-4,
            "{}: {stretch_m:e} m along the leg",
            ready.name
        );
        let tip_m = worst(&file, hold_in_f32(&file)).tip_m;
        println!("{}: {tip_m:.1e} m in f32", ready.name);
        assert!(tip_m <= 1e-6, "{}: {tip_m:e} m in f32", ready.name);
        assert!(tip_m > 1e-9, "{}: {tip_m:e} m: was this f32?", ready.name);
    }
}

/// The leg with an unknown payload: it rests somewhere, its tensions are measured with errors, and the lengths are set
/// for the load that they tell; seven times.
fn error_after_estimates_m(
    file: &RigFile,
    azimuth: f64,
    tilt: f64,
    payload_kg: f64,
    errors: [f64; 3],
) -> f64 {
    let rig = Rig::new(&file.parameters).unwrap();
    let target = Direction::from_angles(azimuth, tilt).unwrap();
    let pretension = feasible_pretension(file, azimuth, tilt, payload_kg).unwrap();
    let wide = TensionBounds::new(0.0, 200.0).unwrap();
    let (support, tendons) = (file.support, file.tendons);
    let mut moment = Load::new(&rig, 0.0).unwrap().moment(&target);
    let mut error = f64::NAN;
    for _ in 0..8 {
        let held = inverse_statics(
            &rig, &support, &target, &moment, &wide, &tendons, pretension,
        )
        .unwrap();
        let (balance, posture) = rest(file, held.unstretched, payload_kg, &target);
        error = tip_error_m(file, &posture, &target);
        let factors = Vector3::from(errors).map(|error| 1.0 + error);
        let measured = balance
            .tensions_n(&posture)
            .unwrap()
            .component_mul(&factors);
        let twist = support
            .twist(&posture.direction)
            .composed(&Twist::from_torsion(posture.torsion));
        let geometry = rig.geometry().twisted(&twist);
        moment = estimate_load(
            &geometry,
            &support,
            &posture.direction,
            posture.torsion,
            &measured,
        )
        .unwrap();
    }
    error
}

#[test]
fn an_unknown_load_is_estimated_from_the_tensions() {
    let file = RigFile::load(None).unwrap();
    let sign = |bits: u8, bit: u8| if bits & bit == 0 { -1.0 } else { 1.0 };
    let patterns = (0..8).map(|bits| [1, 2, 4].map(|bit| sign(bits, bit)));
    let patterns: Vec<[f64; 3]> = patterns.collect();
    let (mut exact, mut one_percent) = (0.0_f64, 0.0_f64);
    for payload_kg in PAYLOADS_KG {
        for (azimuth, tilt) in poses(file.tilt_deg).step_by(5) {
            exact = exact.max(error_after_estimates_m(
                &file, azimuth, tilt, payload_kg, [0.0; 3],
            ));
            for pattern in &patterns {
                let errors = pattern.map(|sign| 0.01 * sign);
                one_percent = one_percent.max(error_after_estimates_m(
                    &file, azimuth, tilt, payload_kg, errors,
                ));
            }
        }
    }
    println!(
        "exact tensions {:.1e} mm, 1 % off {:.3} mm",
        exact * 1e3,
        one_percent * 1e3
    );
    assert!(exact < 1e-10, "{exact:e} m with exact tensions");
    assert!(
        (5e-5..2e-4).contains(&one_percent),
        "{one_percent:e} m with tensions 1 % off"
    );
}
