//! Stiffness on command: the pretension that makes the leg as stiff as demanded, inside the bounds on the tensions.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_base::angles;
use leg_model::{
    Bound, Direction, Error, Load, Query, Rig, StiffnessAnswer, StiffnessDemand, TensionBounds,
    evaluate, inverse_statics,
};
use leg_model_tools::nonlinear::{Balance, Posture};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use nalgebra::Vector3;

fn table_1() -> RigFile {
    RigFile::load(None).unwrap()
}

fn answer(
    file: &RigFile,
    (azimuth_deg, tilt_deg, payload_kg): (f64, f64, f64),
    stiffness_nm_per_rad: f64,
    towards_deg: Option<f64>,
) -> Result<StiffnessAnswer<f64>, Error> {
    let query = Query {
        demand: Some(StiffnessDemand {
            stiffness_nm_per_rad,
            towards_rad: towards_deg.map(f64::to_radians),
        }),
        ..file.query(azimuth_deg, tilt_deg, payload_kg)
    };
    evaluate(&file.parameters, &query).map(|evaluation| evaluation.commanded.unwrap())
}

/// At the vertical, without weights, tensions of 8 to 150 N give 12.8 to 178 N·m/rad.
#[test]
fn the_range_at_the_vertical_is_known() {
    let mut file = table_1();
    file.parameters.gravity_m_per_s2 = 0.0;
    for (demanded, [given, within], pretension_n, end) in [
        (1.0, [12.8, 0.06], 8.0, Bound::Min),
        (500.0, [178.0, 0.6], 150.0, Bound::Max),
    ] {
        let found = answer(&file, (0.0, 0.0, 0.0), demanded, None).unwrap();
        let off = found.stiffness_nm_per_rad - given;
        assert!(off.abs() < within, "{found:?}");
        assert!((found.pretension_n - pretension_n).abs() < 1e-9);
        assert!(found.limit.is_some_and(|limit| limit.bound == end));
    }
}

/// With a floor below the tension at which the tendons are softest, stiffness first falls with the pretension, then rises.
#[test]
fn a_demand_between_the_ends_of_a_range_that_dips_is_met() {
    let mut file = table_1();
    file.f_min_n = 0.5;
    let pose = (0.0, 0.0, 1.0);
    let met = answer(&file, pose, 20.0, None).unwrap();
    assert!(
        (met.stiffness_nm_per_rad / 20.0 - 1.0).abs() < 2e-4,
        "{met:?}"
    );
    assert_eq!(met.limit, None);
    // Softer than the softest: the nearest pretension is inside, and no bound stops it.
    let softest = answer(&file, pose, 10.0, None).unwrap();
    assert!((softest.pretension_n - 8.0).abs() < 6.0, "{softest:?}");
    assert!(softest.stiffness_nm_per_rad < 17.5, "{softest:?}");
    assert_eq!(softest.limit, None);
    // Also where the upper end of the range is the nearer one.
    file.f_max_n = 12.0;
    let from_above = answer(&file, pose, 10.0, None).unwrap();
    let (a, b) = (softest.pretension_n, from_above.pretension_n);
    assert!((a - b).abs() < 0.2, "{softest:?} {from_above:?}");
    assert_eq!(from_above.limit, None);
    let pushed_m = pushed(&file, pose, met.pretension_n, 0.0);
    assert!((pushed_m / 20.0 - 1.0).abs() < 0.05, "{pushed_m}");
}

/// The search keeps two pretensions between which the demand is: steps of the secant method alone lead out of the range, or never
/// end.
#[test]
fn every_demand_above_the_softest_of_a_range_that_dips_is_met() {
    let mut file = table_1();
    file.f_min_n = 1.0;
    for tilt_deg in [12.0, 28.0] {
        let pose = (17.0, tilt_deg, 0.5);
        let softest = answer(&file, pose, 1.0, None).unwrap();
        for part in 1..100 {
            let demand = softest.stiffness_nm_per_rad * (1.0 + 0.02 * f64::from(part));
            let found = answer(&file, pose, demand, None).unwrap();
            let off = found.stiffness_nm_per_rad / demand - 1.0;
            assert!(off.abs() <= 1e-4, "{pose:?}, {demand}: {found:?}");
        }
    }
}

/// The softest stiffness in a pose, N·m/rad, with each tendon at its own tension, and the range of pretensions, N.
fn softest(
    file: &RigFile,
    (azimuth_deg, tilt_deg, payload_kg): (f64, f64, f64),
    pretension_n: f64,
) -> (f64, [f64; 2]) {
    let query = Query {
        pretension_n,
        stiffness_at: leg_model::StiffnessAt::Tension,
        ..file.query(azimuth_deg, tilt_deg, payload_kg)
    };
    let found = evaluate(&file.parameters, &query).unwrap();
    let [softest, _] = found.bending_stiffness_nm_per_rad;
    (softest, found.pretension_range_n)
}

/// Both ends of the range are stiffer, and a few newtons above the lower one the leg is softer: the demand is between.
#[test]
fn a_demand_slightly_below_the_stiffness_at_the_lowest_pretension_is_met() {
    let mut file = table_1();
    file.f_min_n = 1.0;
    let found = answer(&file, (17.0, 0.0, 0.5), 25.0, None).unwrap();
    let off = found.stiffness_nm_per_rad / 25.0 - 1.0;
    assert!(off.abs() <= 1e-4, "{found:?}");
    assert_eq!(found.limit, None);
}

/// The stiffness has corners, where the tendons are softest: there the false position alone creeps.
#[test]
fn a_search_over_the_corners_of_the_stiffness_ends() {
    const DEMAND: f64 = 22.155_744_724_242_32;
    let mut file = table_1();
    file.f_min_n = 1.0;
    let found = answer(&file, (17.0, 20.0, 0.5), DEMAND, None).unwrap();
    let off = found.stiffness_nm_per_rad / DEMAND - 1.0;
    assert!(off.abs() <= 1e-4, "{found:?}");
    assert_eq!(found.limit, None);
}

/// Whatever is demanded is answered, and what lies between the softest and the stiffest of the range is met.
#[test]
fn what_some_pretension_gives_is_met_at_every_floor() {
    const SAMPLES: u32 = 200;
    let mut file = table_1();
    for floor_n in [0.5, 1.0, 2.0, 4.0, 6.0, 8.0] {
        file.f_min_n = floor_n;
        for azimuth_deg in [0.0, 17.0, 45.0, 250.0] {
            for (tilt_deg, payload_kg) in [
                (0.0, 0.5),
                (5.0, 0.5),
                (12.0, 1.0),
                (20.0, 0.5),
                (28.0, 0.0),
            ] {
                let pose = (azimuth_deg, tilt_deg, payload_kg);
                let (_, [low, high]) = softest(&file, pose, file.pretension_n);
                let samples = (0..=SAMPLES).map(|i| {
                    let part = f64::from(i) / f64::from(SAMPLES);
                    softest(&file, pose, low + part * (high - low)).0
                });
                let (least, most) = samples.fold((f64::MAX, 0.0_f64), |(least, most), given| {
                    (least.min(given), most.max(given))
                });
                for percent in -20..=120 {
                    // More of the demands are near the softest, where the stiffness falls and rises again.
                    let part = f64::from(percent) / 100.0;
                    let demand = least + part * part.abs() * (most - least);
                    if demand <= 0.0 {
                        continue;
                    }
                    let found = answer(&file, pose, demand, None).unwrap();
                    // Beyond them, an end is the answer unless a pretension is nearer by a hundredth.
                    let nearest = (demand.clamp(least, most) - demand).abs();
                    let allowed = if nearest == 0.0 { 1e-4 } else { 1e-2 };
                    let off = (found.stiffness_nm_per_rad - demand).abs();
                    assert!(
                        off <= nearest + allowed * demand,
                        "{floor_n}, {pose:?}, {demand}: {found:?}"
                    );
                    let (given, _) = softest(&file, pose, found.pretension_n);
                    let told = found.stiffness_nm_per_rad;
                    assert!((told / given - 1.0).abs() < 1e-9, "{given}: {found:?}");
                }
            }
        }
    }
}

#[test]
fn at_the_edge_with_2_kg_only_pretensions_from_61_7_to_83_8_are_allowed() {
    let file = table_1();
    let at_edge = (30.0, 30.0, 2.0);
    let [low, high] = [1.0, 500.0].map(|demand| answer(&file, at_edge, demand, None).unwrap());
    assert!(
        (low.pretension_n - 61.7).abs() < 0.05 && (high.pretension_n - 83.8).abs() < 0.1,
        "{low:?} {high:?}"
    );
    // Both ends name the tendon that stops them.
    for end in [low, high] {
        let limit = end.limit.unwrap();
        assert!((1..=3).contains(&limit.tendon));
    }
}

/// Stiffness rises with the pretension from end to end, so that the nearer end is the best.
#[test]
fn stiffness_rises_with_the_pretension_over_the_workspace() {
    let file = table_1();
    for azimuth in (0..360).step_by(20) {
        for (tilt, payload) in [
            (0.0, 0.0),
            (10.0, 1.0),
            (20.0, 0.5),
            (30.0, 2.0),
            (30.0, 0.0),
        ] {
            let pose = (f64::from(azimuth), tilt, payload);
            let [low, high] = [1e-3, 1e5].map(|demand| answer(&file, pose, demand, None).unwrap());
            let mut before = low;
            for step in 1..20 {
                let part = f64::from(step) / 20.0;
                let range = high.stiffness_nm_per_rad - low.stiffness_nm_per_rad;
                let demand = low.stiffness_nm_per_rad + part * range;
                let found = answer(&file, pose, demand, None).unwrap();
                assert_eq!(found.limit, None);
                assert!(
                    (found.stiffness_nm_per_rad / demand - 1.0).abs() <= 1e-4,
                    "{found:?}"
                );
                assert!(
                    found.pretension_n > before.pretension_n,
                    "{pose:?}: {found:?} {before:?}"
                );
                before = found;
            }
        }
    }
}

/// What a small push at the tip towards an azimuth meets in the nonlinear model, N·m/rad: F·L by δ/L.
fn pushed(file: &RigFile, pose: (f64, f64, f64), pretension: f64, towards_deg: f64) -> f64 {
    const PUSH_N: f64 = 1e-3;
    let (azimuth_deg, tilt_deg, payload_kg) = pose;
    let rig = Rig::new(&file.parameters).unwrap();
    let target = Direction::from_angles(azimuth_deg.to_radians(), tilt_deg.to_radians()).unwrap();
    let load = Load::new(&rig, payload_kg).unwrap();
    let bounds = TensionBounds::new(file.f_min_n, file.f_max_n).unwrap();
    let (support, tendons) = (file.support, file.tendons);
    let moment = load.moment(&target);
    let held = inverse_statics(
        &rig, &support, &target, &moment, &bounds, &tendons, pretension,
    )
    .unwrap();
    let balance = Balance::new(rig, load, support, tendons, held.unstretched);
    let p = target.vector();
    let [x, y] = angles::unit_vector(towards_deg);
    let horizontal = Vector3::new(x, y, 0.0);
    let way = (horizontal - p * p.dot(&horizontal)).normalize();
    let tip_along = |force: f64| {
        let start = Posture {
            direction: target,
            torsion: 0.0,
        };
        let rest = balance.pushed(way * force).rest(start).unwrap();
        rest.direction.vector().dot(&way)
    };
    let angle = tip_along(PUSH_N) - tip_along(-PUSH_N);
    2.0 * PUSH_N * rig.tip_m() / angle
}

/// A push the way that is meant shows the stiffness that was demanded.
#[test]
fn a_push_in_the_nonlinear_model_shows_the_demanded_stiffness() {
    let file = table_1();
    for (pose, demand) in [
        ((0.0, 0.0, 1.0), 60.0),
        ((30.0, 20.0, 1.0), 90.0),
        ((200.0, 25.0, 0.5), 70.0),
    ] {
        for towards in [0.0, 45.0, 120.0, 250.0] {
            let commanded = answer(&file, pose, demand, Some(towards)).unwrap();
            assert_eq!(commanded.limit, None);
            let shown = pushed(&file, pose, commanded.pretension_n, towards);
            assert!(
                (shown / demand - 1.0).abs() < 0.02,
                "{pose:?} towards {towards}°: {shown}"
            );
        }
    }
}

#[test]
fn every_support_is_as_stiff_as_demanded() {
    for ready in READY_RIGS {
        let file = RigFile::parse(ready.name, ready.text).unwrap();
        let found = answer(&file, (100.0, 15.0, 0.5), 75.0, None).unwrap();
        assert_eq!(found.limit, None, "{}", ready.name);
        let query = Query {
            pretension_n: found.pretension_n,
            stiffness_at: leg_model::StiffnessAt::Tension,
            ..file.query(100.0, 15.0, 0.5)
        };
        let [softest, _] = evaluate(&file.parameters, &query)
            .unwrap()
            .bending_stiffness_nm_per_rad;
        // The twist of a support with three freedoms changes a little with the pretension.
        assert!(
            (softest / 75.0 - 1.0).abs() < 2e-3,
            "{}: {softest}",
            ready.name
        );
    }
}

#[test]
fn a_demand_that_cannot_be_is_refused() {
    use leg_model::{Quantity, Reason};
    let file = table_1();
    let pose = (0.0, 10.0, 1.0);
    let refused = |quantity, reason| Err(Error::Refused { quantity, reason });
    let bending = Quantity::BendingStiffness;
    assert_eq!(
        answer(&file, pose, -4.0, None),
        refused(bending, Reason::NotPositive)
    );
    assert_eq!(
        answer(&file, pose, 0.0, None),
        refused(bending, Reason::NotPositive)
    );
    assert_eq!(
        answer(&file, pose, f64::NAN, None),
        refused(bending, Reason::NotFinite)
    );
    assert_eq!(
        answer(&file, pose, 2e6, None),
        refused(bending, Reason::OutOfRange)
    );
    let azimuth = Quantity::DemandAzimuth;
    assert_eq!(
        answer(&file, pose, 50.0, Some(1e9)),
        refused(azimuth, Reason::OutOfRange)
    );
    assert_eq!(
        answer(&file, (30.0, 30.0, 3.0), 50.0, None),
        Err(Error::Infeasible)
    );
}
