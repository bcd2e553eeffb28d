use super::{DARK, LIGHT, tension};
use egui::Color32;

/// The parts of light of a colour.
fn linear(colour: Color32) -> [f64; 3] {
    [colour.r(), colour.g(), colour.b()].map(|channel| {
        let part = f64::from(channel) / 255.0;
        if part <= 0.040_45 {
            part / 12.92
        } else {
            ((part + 0.055) / 1.055).powf(2.4)
        }
    })
}

fn times(matrix: &[[f64; 3]; 3], light: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row.iter().zip(light).map(|(a, b)| a * b).sum())
}

fn luminance(colour: Color32) -> f64 {
    let [red, green, blue] = linear(colour);
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}

/// What people see who have all cones, or lack those for red, for green or for blue: Machado, Oliveira and Fernandes 2009, severity 1.
const SIGHTS: [(&str, [[f64; 3]; 3]); 4] = [
    ("all", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    (
        "protanopia",
        [
            [0.152_286, 1.052_583, -0.204_868],
            [0.114_503, 0.786_281, 0.099_216],
            [-0.003_882, -0.048_116, 1.051_998],
        ],
    ),
    (
        "deuteranopia",
        [
            [0.367_322, 0.860_646, -0.227_968],
            [0.280_085, 0.672_501, 0.047_413],
            [-0.011_820, 0.042_940, 0.968_881],
        ],
    ),
    (
        "tritanopia",
        [
            [1.255_528, -0.076_749, -0.178_779],
            [-0.078_411, 0.930_809, 0.147_602],
            [0.004_733, 0.691_367, 0.303_900],
        ],
    ),
];

/// Oklab's coordinates of light: distances in it are as large as they look.
fn oklab(light: [f64; 3]) -> [f64; 3] {
    let cones = times(
        &[
            [0.412_221_470_8, 0.536_332_536_3, 0.051_445_992_9],
            [0.211_903_498_2, 0.680_699_545_1, 0.107_396_956_6],
            [0.088_302_461_9, 0.281_718_837_6, 0.629_978_700_5],
        ],
        light.map(|part| part.clamp(0.0, 1.0)),
    );
    times(
        &[
            [0.210_454_255_3, 0.793_617_785_0, -0.004_072_046_8],
            [1.977_998_495_1, -2.428_592_205_0, 0.450_593_709_9],
            [0.025_904_037_1, 0.782_771_766_2, -0.808_675_766_0],
        ],
        cones.map(f64::cbrt),
    )
}

/// How different two colours look to who sees the least difference.
fn distance(a: Color32, b: Color32) -> f64 {
    let distances = SIGHTS.iter().map(|(_, sight)| {
        let [a, b] = [a, b].map(|colour| oklab(times(sight, linear(colour))));
        a.iter()
            .zip(b)
            .map(|(a, b)| (a - b).powi(2))
            .sum::<f64>()
            .sqrt()
    });
    distances.fold(f64::INFINITY, f64::min)
}

/// Colours this far apart are told apart without looking twice: a difference of 0.02 is just seen.
const APART: f64 = 0.085;

fn assert_apart(colours: &[(&str, Color32)]) {
    for (i, (name, a)) in colours.iter().enumerate() {
        for (other, b) in &colours[i + 1..] {
            let apart = distance(*a, *b);
            assert!(apart >= APART, "{name} and {other}: {apart:.3}");
        }
    }
}

#[test]
fn who_lacks_cones_tells_tendons_faults_and_targets_apart() {
    for palette in [DARK, LIGHT] {
        let [first, second, third] = palette.series;
        assert_apart(&[
            ("tendon 1", first),
            ("tendon 2", second),
            ("tendon 3", third),
            ("where it was sent", palette.target),
            ("where it is, and faults", palette.error),
            ("limits", palette.warning),
        ]);
        assert_apart(&[
            ("good", palette.good),
            ("error", palette.error),
            ("warning", palette.warning),
        ]);
        assert_apart(&[("text", palette.text), ("not known", palette.faint)]);
    }
}

#[test]
fn who_lacks_cones_tells_tensions_apart() {
    let bounds = [8.0, 150.0];
    let named = ["slack", "low", "middle", "high", "above"];
    let tensions = [7.9, 8.0, 79.0, 150.0, 150.1].map(|n| tension(n, bounds));
    let colours: Vec<_> = named.into_iter().zip(tensions).collect();
    assert_apart(&colours);
}

/// The map's lowest and highest value, and where there is none.
#[test]
fn who_lacks_cones_tells_the_ends_of_a_map_apart() {
    for palette in [DARK, LIGHT] {
        let [low, high] = [0.0, 1.0].map(|part| crate::map_mesh::colour(&palette, part));
        assert_apart(&[("low", low), ("high", high)]);
    }
}

fn contrast(a: Color32, b: Color32) -> f64 {
    let (a, b) = (luminance(a), luminance(b));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

/// The contrast that WCAG 2 asks for of text. Numbers and words are written in the colours of what is drawn, too.
#[test]
fn everything_can_be_read() {
    for palette in [DARK, LIGHT] {
        let written = [
            ("text", palette.text),
            ("faint", palette.faint),
            ("target", palette.target),
            ("error", palette.error),
            ("good", palette.good),
            ("warning", palette.warning),
        ];
        let series = palette.series.map(|colour| ("series", colour));
        for back in [palette.back, palette.card] {
            for (name, colour) in written.into_iter().chain(series) {
                let contrast = contrast(colour, back);
                assert!(contrast >= 4.5, "{name} on {back:?}: {contrast:.2}");
            }
        }
        assert!(contrast(Color32::WHITE, palette.danger) >= 4.5);
    }
}

#[test]
fn tensions_out_of_bounds_have_colours_of_their_own() {
    let bounds = [8.0, 150.0];
    let [slack, low, middle, high, above] =
        [7.9, 8.0, 79.0, 150.0, 150.1].map(|n| tension(n, bounds));
    assert_eq!(tension(f64::NAN, bounds), slack);
    let all = [slack, low, middle, high, above];
    for (i, a) in all.iter().enumerate() {
        assert!(all[i + 1..].iter().all(|b| a != b));
    }
    assert!(low.b() > low.r() && high.r() > high.b());
}
