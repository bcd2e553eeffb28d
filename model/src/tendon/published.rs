//! The tendon of the paper, as far as the paper describes it.

use super::{CURVE_POINTS_MAX, CurvePoint};

macro_rules! paper {
    ($($t:ty),*) => {$(
        impl CurvePoint<$t> {
            /// A curve through what the paper publishes: a stiffness of 2.9·10⁴ N/m when the pull begins, the lowest,
            /// 1.5·10⁴ N/m, at 8 N, and the 9.945·10⁴ N/m at a pretension of 70 N that the maxima of Fig. 9 fix.
            ///
            /// In between the stiffness is taken as linear in the tension, so δ is a logarithm. That is a choice: the
            /// paper's slope and pretension cannot be separated, and its test piece (0.6 mm × 120 mm) is not the rig's
            /// tendon (0.8 mm × 100 mm).
            pub const PAPER: [Self; CURVE_POINTS_MAX] = {
                const fn point(tension_n: $t, elongation_m: $t, stiffness_n_per_m: $t) -> CurvePoint<$t> {
                    CurvePoint { tension_n, elongation_m, stiffness_n_per_m }
                }
                [
                    point(0.0, 0.0, 29000.0),
                    point(2.0, 7.349564446976774e-05, 25500.0),
                    point(4.0, 0.0001578590723589475, 22000.0),
                    point(6.0, 0.0002568714845155399, 18500.0),
                    point(8.0, 0.00037671178793386513, 15000.0),
                    point(12.0, 0.0006041947491839705, 20448.387096774193),
                    point(17.0, 0.0008152480347322186, 27258.870967741936),
                    point(24.0, 0.001035455226825222, 36793.54838709677),
                    point(33.0, 0.001246576051911683, 49052.419354838705),
                    point(45.0, 0.001457717992030637, 65397.58064516129),
                    point(57.0, 0.0016215035334203108, 81742.74193548386),
                    point(70.0, 0.0017654565820163022, 99450.0),
                    point(95.0, 0.001981641364524586, 133502.4193548387),
                    point(120.0, 0.0021484364829660787, 167554.8387096774),
                    point(150.0, 0.002308655456737244, 208417.74193548385),
                    point(200.0, 0.002516238389659529, 276522.5806451613),
                ]
            };
        }
    )*};
}

paper!(f32, f64);
