//! Fig. 10: the deviation over the workspace with 1 kg.

use super::deviation::constant;
use super::row::{PaperRow, Topic, Verdict};
use leg_model::{Error, Query, StiffnessAt, evaluate};
use leg_rig::rig_file::RigFile;

/// The payload of the figure.
pub(super) const PAYLOAD_KG: f64 = 1.0;

/// What the paper says of the spread over the azimuth, percent.
pub(super) const SPREAD_PERCENT: f64 = 1.4;

/// The deviations at 360 azimuths, m.
fn ring(
    rig: &RigFile,
    query: impl Fn(f64) -> Result<Query<f64>, Error>,
) -> Result<Vec<f64>, Error> {
    let deviation =
        |azimuth: u32| Ok(evaluate(&rig.parameters, &query(azimuth.into())?)?.deviation_m);
    (0..360).map(deviation).collect()
}

/// Those on tendons of constant stiffness.
fn constant_ring(rig: &RigFile, tilt_deg: f64) -> Result<Vec<f64>, Error> {
    ring(rig, |azimuth_deg| {
        constant(rig, azimuth_deg, tilt_deg, PAYLOAD_KG)
    })
}

/// Those at the edge on the rig's own curves, each tendon's stiffness at its tension.
fn own_tension_ring(rig: &RigFile) -> Result<Vec<f64>, Error> {
    ring(rig, |azimuth_deg| {
        Ok(Query {
            stiffness_at: StiffnessAt::Tension,
            ..rig.query(azimuth_deg, rig.tilt_deg, PAYLOAD_KG)
        })
    })
}

/// Largest less smallest, in percent of the mean.
fn spread_percent(deviations: &[f64]) -> f64 {
    let largest = deviations.iter().copied().fold(0.0, f64::max);
    let smallest = deviations.iter().copied().fold(f64::INFINITY, f64::min);
    let mean = deviations.iter().sum::<f64>() / deviations.len() as f64;
    100.0 * (largest - smallest) / mean
}

/// The spread over the azimuth at a tilt, percent.
pub(super) fn spread_at(rig: &RigFile, tilt_deg: f64) -> Result<f64, Error> {
    Ok(spread_percent(&constant_ring(rig, tilt_deg)?))
}

pub(super) fn rows(rig: &RigFile) -> Result<Vec<PaperRow>, Error> {
    let spread = |what: String, ring: Vec<f64>, expected, why| {
        let numbers = (SPREAD_PERCENT, spread_percent(&ring));
        let row = PaperRow::new(Topic::Workspace, what, numbers, ("%", 2), why);
        row.limit().expected(expected)
    };
    let at_edge = "at the edge the tendons' levers and lengths differ with the azimuth; what the paper says holds to about \
                   20° on this rig";
    let mut rows = Vec::new();
    for (tilt_deg, expected, why) in [
        (10.0, Verdict::Agrees, "nearly round"),
        (20.0, Verdict::Agrees, "nearly round"),
        (30.0, Verdict::Differs, at_edge),
    ] {
        let what = format!("spread over the azimuth at a tilt of {tilt_deg}°");
        rows.push(spread(what, constant_ring(rig, tilt_deg)?, expected, why));
    }
    rows.push(spread(
        "the same at 30°, stiffness at each tendon's tension".into(),
        own_tension_ring(rig)?,
        Verdict::Differs,
        "read so, the tendons' stiffnesses differ with the azimuth as well",
    ));
    let what = "steps of 1° outwards at which the deviation does not grow, of 10 800";
    let why = "smallest in the centre, growing with the tilt";
    let numbers = (0.0, f64::from(steps_without_growth(rig)?));
    rows.push(PaperRow::new(Topic::Workspace, what, numbers, ("", 0), why).limit());
    Ok(rows)
}

fn steps_without_growth(rig: &RigFile) -> Result<u32, Error> {
    let mut count = 0;
    let mut inner = constant_ring(rig, 0.0)?;
    for tilt in 1..=30 {
        let outer = constant_ring(rig, f64::from(tilt))?;
        let pairs = inner.iter().zip(&outer);
        count += pairs
            .map(|(inner, outer)| u32::from(inner >= outer))
            .sum::<u32>();
        inner = outer;
    }
    Ok(count)
}
