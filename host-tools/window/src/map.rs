//! A map over the workspace: what the model says of every pose under the present payload and pretension.

use leg_model::{Evaluation, evaluate};
use leg_rig::rig_file::RigFile;

/// Rings of the grid.
pub const RINGS: usize = 12;
/// Its spokes.
pub const SPOKES: usize = 48;

/// Payload and pretension within these are the same for a map, kg and N.
const SAME_KG: f64 = 0.02;
const SAME_N: f64 = 0.5;

/// What a map shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// How far the tip would sag without compensation, mm.
    Sag,
    /// The smallest stiffness against a push, N·m/rad.
    Stiffness,
    /// How far the tensions are from the nearest bound, N.
    Margin,
}

impl Quantity {
    /// All of them, with their names and units.
    pub const ALL: [(Self, &'static str, &'static str); 3] = [
        (Self::Sag, "sag", "mm"),
        (Self::Stiffness, "stiffness", "N·m/rad"),
        (Self::Margin, "margin", "N"),
    ];

    /// Its name and its unit.
    #[must_use]
    pub fn words(self) -> [&'static str; 2] {
        let found = Self::ALL.iter().find(|(quantity, ..)| *quantity == self);
        found.map_or([""; 2], |(_, name, unit)| [name, unit])
    }

    fn value(self, pose: &Evaluation<f64>, rig: &RigFile) -> f64 {
        match self {
            Self::Sag => 1000.0 * pose.deviation_m,
            Self::Stiffness => pose.bending_stiffness_nm_per_rad[0],
            Self::Margin => {
                let margins = pose
                    .tensions_n
                    .iter()
                    .map(|n| (n - rig.f_min_n).min(rig.f_max_n - n));
                margins.fold(f64::INFINITY, f64::min)
            }
        }
    }
}

/// A map, and for what it holds.
#[derive(Clone, Debug)]
pub struct Map {
    quantity: Quantity,
    payload_kg: f64,
    pretension_n: f64,
    /// The sine of the largest tilt.
    sine_max: f64,
    /// The centre, then each ring from the inside out; not a number where the model has no answer.
    values: Vec<f64>,
}

impl Map {
    /// Of a rig.
    #[must_use]
    pub fn new(quantity: Quantity, rig: &RigFile, payload_kg: f64, pretension_n: f64) -> Self {
        let value = |azimuth_deg: f64, tilt_deg: f64| {
            let mut query = rig.query(azimuth_deg, tilt_deg, payload_kg);
            query.pretension_n = pretension_n;
            evaluate(&rig.parameters, &query).map_or(f64::NAN, |pose| quantity.value(&pose, rig))
        };
        let sine_max = rig.tilt_deg.to_radians().sin();
        let mut values = vec![value(0.0, 0.0)];
        for ring in 1..=RINGS {
            let sine = sine_max * ring as f64 / RINGS as f64;
            let tilt_deg = sine.asin().to_degrees();
            values.extend((0..SPOKES).map(|spoke| value(azimuth_deg(spoke), tilt_deg)));
        }
        Self {
            quantity,
            payload_kg,
            pretension_n,
            sine_max,
            values,
        }
    }

    /// Whether it still holds.
    #[must_use]
    pub fn holds(&self, quantity: Quantity, payload_kg: f64, pretension_n: f64) -> bool {
        self.quantity == quantity
            && (self.payload_kg - payload_kg).abs() <= SAME_KG
            && (self.pretension_n - pretension_n).abs() <= SAME_N
    }

    /// What it shows.
    #[must_use]
    pub const fn quantity(&self) -> Quantity {
        self.quantity
    }

    /// Whether the model has no answer somewhere.
    #[must_use]
    pub fn has_gaps(&self) -> bool {
        self.values.iter().any(|value| !value.is_finite())
    }

    /// The sine of the largest tilt.
    #[must_use]
    pub const fn sine_max(&self) -> f64 {
        self.sine_max
    }

    /// The values: the centre, then each ring from the inside out.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The lowest and the highest; none if the model has no answer anywhere.
    #[must_use]
    pub fn range(&self) -> Option<[f64; 2]> {
        let known = self.values.iter().filter(|value| value.is_finite());
        let range = known.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
            [low.min(*value), high.max(*value)]
        });
        (range[0] <= range[1]).then_some(range)
    }
}

/// The azimuth of a spoke, degrees.
#[must_use]
pub fn azimuth_deg(spoke: usize) -> f64 {
    360.0 * spoke as f64 / SPOKES as f64
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Map, Quantity, RINGS, SPOKES};
    use leg_model::{Evaluation, evaluate};
    use leg_rig::rig_file::RigFile;

    #[test]
    fn the_sag_is_that_of_fig_9_at_the_edge_and_none_in_the_middle() {
        let rig = RigFile::load(None).unwrap();
        let map = Map::new(Quantity::Sag, &rig, 2.0, 70.0);
        assert_eq!(map.values().len(), 1 + RINGS * SPOKES);
        let [low, high] = map.range().unwrap();
        // The paper's Fig. 9 has 8.5 mm at azimuth 30°.
        let at_30_deg = map.values()[1 + (RINGS - 1) * SPOKES + SPOKES / 12];
        assert!((8.3..8.6).contains(&at_30_deg), "{at_30_deg}");
        assert!(low < 1e-6 && high < 9.0, "{low} {high}");
    }

    const PAYLOAD_KG: f64 = 0.5;

    /// What the model says at a place of the map.
    fn pose(rig: &RigFile, ring: usize, spoke: usize, pretension_n: f64) -> Evaluation<f64> {
        let sine = rig.tilt_deg.to_radians().sin() * ring as f64 / RINGS as f64;
        let azimuth_deg = 7.5 * spoke as f64;
        let mut query = rig.query(azimuth_deg, sine.asin().to_degrees(), PAYLOAD_KG);
        query.pretension_n = pretension_n;
        evaluate(&rig.parameters, &query).unwrap()
    }

    fn value(map: &Map, ring: usize, spoke: usize) -> f64 {
        map.values()[1 + (ring - 1) * SPOKES + spoke]
    }

    /// Places all over a map.
    fn places() -> impl Iterator<Item = (usize, usize)> {
        (1..=RINGS)
            .step_by(4)
            .flat_map(|ring| (0..SPOKES).step_by(7).map(move |spoke| (ring, spoke)))
    }

    #[test]
    fn deviation_and_stiffness_are_the_models_at_every_place() {
        let rig = RigFile::load(None).unwrap();
        let [sag, stiffness] = [Quantity::Sag, Quantity::Stiffness]
            .map(|quantity| Map::new(quantity, &rig, PAYLOAD_KG, 70.0));
        for (ring, spoke) in places() {
            let pose = pose(&rig, ring, spoke, 70.0);
            let at = format!("ring {ring}, spoke {spoke}");
            let sag_mm = value(&sag, ring, spoke);
            assert!(
                (sag_mm - 1e3 * pose.deviation_m).abs() < 1e-9,
                "{at}: {sag_mm} mm"
            );
            let [least, most] = pose.bending_stiffness_nm_per_rad;
            let shown = value(&stiffness, ring, spoke);
            assert!(
                (shown - least).abs() < 1e-9 && least < most,
                "{at}: {shown} N·m/rad"
            );
        }
        let [low, high] = stiffness.range().unwrap();
        assert!(20.0 < low && low < high && high < 200.0, "{low} {high}");
    }

    /// The model names the pretensions at which a tension comes to a bound: there is no margin then.
    #[test]
    fn the_margin_is_that_to_the_nearer_bound_and_none_where_the_model_has_one_reached() {
        let rig = RigFile::load(None).unwrap();
        for (ring, spoke) in places() {
            let [lowest_n, highest_n] = pose(&rig, ring, spoke, 70.0).pretension_range_n;
            for pretension_n in [lowest_n, highest_n] {
                let map = Map::new(Quantity::Margin, &rig, PAYLOAD_KG, pretension_n);
                let shown_n = value(&map, ring, spoke);
                assert!(
                    shown_n.abs() < 1e-6,
                    "ring {ring}, spoke {spoke}: {shown_n} N"
                );
            }
            let map = Map::new(
                Quantity::Margin,
                &rig,
                PAYLOAD_KG,
                0.5 * (lowest_n + highest_n),
            );
            assert!(value(&map, ring, spoke) > 1.0);
            let beyond = Map::new(Quantity::Margin, &rig, PAYLOAD_KG, highest_n + 1.0);
            assert!(value(&beyond, ring, spoke) < 0.0);
        }
    }

    #[test]
    fn it_holds_until_payload_or_pretension_change() {
        let rig = RigFile::load(None).unwrap();
        let map = Map::new(Quantity::Margin, &rig, 1.0, 70.0);
        assert!(map.holds(Quantity::Margin, 1.01, 70.3));
        assert!(!map.holds(Quantity::Sag, 1.0, 70.0));
        assert!(!map.holds(Quantity::Margin, 1.5, 70.0));
        assert!(!map.holds(Quantity::Margin, 1.0, 72.0));
    }
}
