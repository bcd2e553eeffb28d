//! What is seen at the sizes of screens: nothing is covered, nothing moves.

use super::Window;
use crate::fault_words;
use crate::faults::FaultList;
use crate::places;
use crate::scene;
use crate::scrolled;
use egui::{Context, RawInput, Rect, UiBuilder};
use leg_firmware::supervisor::{Fault, FaultSet};
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Defect;

/// Phones held upright and across.
const PHONES: [[f32; 2]; 4] = [
    [390.0, 844.0],
    [360.0, 740.0],
    [320.0, 568.0],
    [844.0, 390.0],
];

/// The rows of a fault's card that are within a room.
fn rows_within(ctx: &Context, rig: &RigFile, room: Rect, fault: Fault) -> Vec<String> {
    let mut list = FaultList::default();
    let mut placed = places::Places::default();
    for frame in 0..6 {
        let input = RawInput {
            // Longer than a card takes to open.
            time: Some(10.0 * f64::from(fault.code()) + f64::from(frame)),
            screen_rect: Some(room),
            ..RawInput::default()
        };
        let mut output = ctx.run_ui(input, |ui| {
            ui.scope_builder(UiBuilder::new().max_rect(room), |ui| {
                let faults = Some(FaultSet::single(fault));
                scrolled::shrunk(ui, "faults", |ui| list.show(ui, faults, rig));
            });
        });
        output.textures_delta.clear();
        placed = places::take(ctx);
    }
    let card = placed.rects[format!("fault_{}", fault.code()).as_str()];
    assert!(
        card.right() <= room.right() + 0.5,
        "{fault:?} {card:?} {room:?}"
    );
    if card.bottom() > room.bottom() {
        println!(
            "{fault:?}: {} points are cut off",
            card.bottom() - room.bottom()
        );
    }
    let rows = placed.rects.into_iter();
    let within = rows.filter(|(_, rect)| rect.bottom() <= room.bottom() + 0.5);
    within.map(|(name, _)| name.to_string()).collect()
}

#[test]
fn what_to_do_about_any_fault_is_seen_beside_the_leg() {
    let room = scene::room(Window::new().rect("leg"));
    let (ctx, rig) = (Context::default(), RigFile::load(None).unwrap());
    crate::theme::install(&ctx);
    let seen_whole = |fault: &Fault| {
        let rows = rows_within(&ctx, &rig, room, *fault);
        let remedy = format!("fault_{}_remedy", fault.code());
        assert!(rows.contains(&remedy), "{fault:?}: {rows:?}");
        rows.contains(&format!("fault_{}", fault.code()))
    };
    let cut_off: Vec<Fault> = Fault::ALL
        .into_iter()
        .filter(|fault| !seen_whole(fault))
        .collect();
    assert_eq!(cut_off, [], "at {room:?}");
}

/// The least widths at which everything is side by side, and a low window.
const SIDE_BY_SIDE: [[f32; 2]; 5] = [
    [960.0, 720.0],
    [1104.0, 720.0],
    [1280.0, 560.0],
    [1280.0, 720.0],
    [1920.0, 1080.0],
];

#[test]
fn faults_are_beside_the_leg_or_below_it_and_cover_nothing() {
    for [width, height] in SIDE_BY_SIDE {
        let mut window = Window::sized(width, height);
        window.press("stiffness_ellipse");
        let leg = window.rect("leg");
        let faults = if window.shows("faults") {
            leg.intersect(window.rect("faults"))
        } else {
            let strip = window.rect("fault_strip");
            assert!(
                !leg.intersects(strip),
                "{width} × {height}: {leg:?} {strip:?}"
            );
            strip
        };
        for drawn in ["rim", "ellipse", "tensions", "readout", "stiffness_words"] {
            let drawn_rect = window.rect(drawn);
            assert!(
                !faults.intersects(drawn_rect),
                "{drawn} at {width} × {height}: {drawn_rect:?} {faults:?}"
            );
        }
        window
            .app
            .stage
            .leg_mut()
            .set_defect(Defect::TendonCut(0), true);
        window.frames(8);
        if window.shows("fault_strip") {
            window.press("fault_strip");
        }
        assert!(window.shows("fault_3_remedy"), "{width} × {height}");
    }
}

#[test]
fn no_button_is_below_a_scroll_bar() {
    let mut seen = 0;
    for [width, height] in SIDE_BY_SIDE.into_iter().chain(PHONES) {
        let mut window = Window::sized(width, height);
        for tab in ["tab_drive", "tab_break"] {
            if window.shows(tab) {
                window.press(tab);
            }
            seen += window.bars.len();
            for (name, rect) in &window.app.places.rects {
                if name == "leg" || name == "charts" {
                    continue;
                }
                for bar in &window.bars {
                    assert!(
                        !bar.intersects(*rect),
                        "{name} at {width} × {height}: {rect:?} {bar:?}"
                    );
                }
            }
        }
    }
    assert!(seen > 0);
}

#[test]
fn the_card_of_a_cut_tendon_is_seen_whole_with_the_value_of_its_limit() {
    let mut window = Window::new();
    let charts = window.rect("charts");
    window.press("cut_3");
    window.frames(60);
    let last = window.rect("fault_3_ends");
    assert!(last.bottom() < charts.top(), "{last:?} {charts:?}");
    let cause = fault_words::with_values(Fault::TensionJump.entry().cause, window.leg().rig());
    assert!(cause.contains("25 N") && window.says(&cause), "{cause}");
}

#[test]
fn a_fault_moves_nothing() {
    let tabs = ["tab_break", "tab_drive", "tab_try", "tab_break"];
    for ([width, height], tab) in PHONES.into_iter().zip(tabs) {
        let mut window = Window::sized(width, height);
        window.press(tab);
        let before = window.app.places.rects.clone();
        let stay = |window: &Window| {
            let now = &window.app.places.rects;
            for (name, rect) in &before {
                assert_eq!(Some(rect), now.get(name), "{name} at {width} × {height}");
            }
        };
        let leg = window.app.stage.leg_mut();
        leg.set_defect(Defect::TendonCut(0), true);
        window.frames(60);
        assert!(window.says("jump of a tension"), "{:?}", window.texts);
        stay(&window);
        window.press("fault_strip");
        let remedy = window.rect("fault_3_remedy");
        assert!(window.rect("leg").contains_rect(remedy), "{remedy:?}");
        stay(&window);
        window.press("fault_strip");
        assert!(!window.shows("fault_3_remedy"));
    }
}

#[test]
fn nothing_overlaps_on_a_phone() {
    for [width, height] in PHONES {
        let mut window = Window::sized(width, height);
        // Late enough that something is left out.
        window.time_s += 3.0;
        window.frames(3);
        assert!(window.says("SIMULATED"), "{width} × {height}");
        for row in [
            &["state", "rate", "theme", "stop"][..],
            &[
                "tab_try",
                "tab_drive",
                "tab_break",
                "tab_charts",
                "tab_setup",
            ],
            &["time", "left_out", "factor", "readout", "tensions"],
        ] {
            for (number, name) in row.iter().enumerate() {
                let rect = window.rect(name);
                assert!(
                    rect.left() >= 0.0 && rect.right() <= width,
                    "{name} {rect:?} at {width} × {height}"
                );
                for other in &row[number + 1..] {
                    let shared = rect.intersect(window.rect(other));
                    assert!(
                        shared.width() <= 0.0 || shared.height() <= 0.0,
                        "{name} and {other} at {width} × {height}: {shared:?}"
                    );
                }
            }
        }
        let [leg, tabs] = ["leg", "tab_try"].map(|name| window.rect(name));
        assert!(!leg.intersects(tabs), "{leg:?} {tabs:?}");
        for tab in ["tab_try", "tab_drive", "tab_break", "tab_charts"] {
            window.press(tab);
            for (name, rect) in &window.app.places.rects {
                assert!(
                    rect.left() >= 0.0 && rect.right() <= width,
                    "{name} in {tab} {rect:?} at {width} × {height}"
                );
            }
        }
    }
}

#[test]
fn a_map_has_a_key_with_its_unit_and_its_ends() {
    let mut window = Window::new();
    let disc = window.rect("workspace");
    window.press("map");
    window.press("map_stiffness");
    window.frames(20);
    assert!(window.rect("map_key").left() > disc.right());
    assert_eq!(window.rect("workspace"), disc);
    assert!(window.says("N·m/rad"));
    // Beside the leg, too, with both ends.
    assert!(window.texts.iter().any(|text| {
        text.starts_with("stiffness, ") && text.contains(" to ") && text.ends_with(" N·m/rad")
    }));
}

#[test]
fn the_words_about_the_stiffness_and_the_key_of_a_map_have_rooms_of_their_own() {
    for [width, height] in [[1280.0, 720.0], [390.0, 844.0], [960.0, 720.0]] {
        let mut window = Window::sized(width, height);
        window.press("stiffness_ellipse");
        if window.shows("tab_drive") {
            window.press("tab_drive");
        }
        window.press("map");
        window.press("map_sag");
        window.frames(3);
        let [words, legend] = ["stiffness_words", "map_legend"].map(|name| window.rect(name));
        assert!(
            !words.intersects(legend),
            "{width} × {height}: {words:?} {legend:?}"
        );
    }
}

#[test]
fn no_words_come_with_the_pointer_over_the_faults() {
    let mut window = Window::new();
    let before = window.texts.len();
    let at = window.rect("workspace").center();
    window.frame(vec![egui::Event::PointerMoved(at)]);
    window.frames(60);
    assert_eq!(window.texts.len(), before, "{:?}", window.texts);
}
