//! Colours that people who see few colours can tell apart, light and dark, and sizes.

use egui::{
    self, Color32, CornerRadius, FontFamily, FontId, Stroke, TextStyle, Theme, Visuals,
    style::ScrollStyle,
};

/// Time from one click to the next in which they are a double click, s: what browsers and systems take. A slow page sees both later
/// than they were.
const DOUBLE_CLICK_S: f64 = 0.5;

/// Width of a scroll bar without the pointer, points.
pub const BAR_WIDTH: f32 = 4.0;

/// A bar is seen wherever something is beyond the edge, before the pointer is there, too: it takes no room.
fn scroll() -> ScrollStyle {
    ScrollStyle {
        floating_width: BAR_WIDTH,
        dormant_handle_opacity: 0.55,
        ..ScrollStyle::floating()
    }
}

/// The colours of what is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette {
    /// Behind everything.
    pub back: Color32,
    /// Behind groups.
    pub card: Color32,
    /// Lines between things.
    pub line: Color32,
    /// Text.
    pub text: Color32,
    /// Text of less weight.
    pub faint: Color32,
    /// Plates.
    pub plate: Color32,
    /// The shaft.
    pub shaft: Color32,
    /// Joint and payload.
    pub brass: Color32,
    /// Where the leg was sent.
    pub target: Color32,
    /// How far it is from there.
    pub error: Color32,
    /// All is well.
    pub good: Color32,
    /// Look at this.
    pub warning: Color32,
    /// The stop.
    pub danger: Color32,
    /// The three tendons in charts, and x, y and z.
    pub series: [Color32; 3],
}

const fn rgb(hex: u32) -> Color32 {
    let [_, red, green, blue] = hex.to_be_bytes();
    Color32::from_rgb(red, green, blue)
}

const DARK: Palette = Palette {
    back: rgb(0x12_17_1d),
    card: rgb(0x1b_22_2b),
    line: rgb(0x36_41_4e),
    text: rgb(0xe4_e9_ee),
    faint: rgb(0x93_a1_af),
    plate: rgb(0x6f_83_98),
    shaft: rgb(0xb4_be_c8),
    brass: rgb(0xd9_ad_4e),
    target: rgb(0x54_b2_eb),
    error: rgb(0xff_6a_3d),
    good: rgb(0x2b_bf_95),
    warning: rgb(0xee_b5_2d),
    danger: rgb(0xd1_3b_1f),
    series: [rgb(0xdc_84_b5), rgb(0xf0_e4_42), rgb(0x9f_d8_ff)],
};

const LIGHT: Palette = Palette {
    back: rgb(0xf4_f6_f8),
    card: rgb(0xff_ff_ff),
    line: rgb(0xcd_d5_dd),
    text: rgb(0x1a_22_2b),
    faint: rgb(0x5a_67_75),
    plate: rgb(0x5b_6b_7d),
    shaft: rgb(0x9a_a3_ad),
    brass: rgb(0xc7_9a_3a),
    target: rgb(0x14_6b_df),
    error: rgb(0x94_35_08),
    good: rgb(0x07_7f_61),
    warning: rgb(0x99_66_00),
    danger: rgb(0xc2_30_17),
    series: [rgb(0xbf_0a_6e), rgb(0x51_2b_b3), rgb(0x4f_64_8d)],
};

/// The colours that are in use.
#[must_use]
pub fn palette(ctx: &egui::Context) -> Palette {
    match ctx.theme() {
        Theme::Dark => DARK,
        Theme::Light => LIGHT,
    }
}

/// The colours of the three tendons in charts, and of x, y and z.
#[must_use]
pub fn series(ctx: &egui::Context, index: usize) -> Color32 {
    let colours = palette(ctx).series;
    colours[index % colours.len()]
}

/// The colour of a tension: blue at the lowest that is allowed, orange at the highest, grey below and purple above.
#[must_use]
pub fn tension(tension_n: f64, [floor_n, ceiling_n]: [f64; 2]) -> Color32 {
    const LOW: Color32 = rgb(0x4a_9c_dc);
    const MIDDLE: Color32 = rgb(0xe6_d9_a8);
    const HIGH: Color32 = rgb(0xd5_5e_00);
    let part = (tension_n - floor_n) / (ceiling_n - floor_n);
    if part.is_nan() || part < 0.0 {
        rgb(0x78_7d_84)
    } else if part > 1.0 {
        rgb(0x98_36_a6)
    } else if part < 0.5 {
        mixed(LOW, MIDDLE, (2.0 * part) as f32)
    } else {
        mixed(MIDDLE, HIGH, (2.0 * part - 1.0) as f32)
    }
}

/// A colour between two.
#[must_use]
pub fn mixed(from: Color32, to: Color32, part: f32) -> Color32 {
    let part = part.clamp(0.0, 1.0);
    let channel = |from: u8, to: u8| {
        let value = f32::from(from) + part * (f32::from(to) - f32::from(from));
        value.round() as u8
    };
    Color32::from_rgb(
        channel(from.r(), to.r()),
        channel(from.g(), to.g()),
        channel(from.b(), to.b()),
    )
}

/// Sets colours and sizes, once.
pub fn install(ctx: &egui::Context) {
    ctx.options_mut(|options| {
        options.input_options.max_double_click_delay = DOUBLE_CLICK_S;
        // A slow page sees a press and its release some frames from each other: however long that takes, it is a click. A long press of a
        // touch has no meaning of its own here.
        options.input_options.max_click_duration = f64::INFINITY;
    });
    for (theme, palette) in [(Theme::Dark, DARK), (Theme::Light, LIGHT)] {
        ctx.set_visuals_of(theme, visuals(theme, &palette));
    }
    ctx.all_styles_mut(|style| {
        let sizes = [
            (TextStyle::Heading, 17.0, FontFamily::Proportional),
            (TextStyle::Body, 14.0, FontFamily::Proportional),
            (TextStyle::Button, 14.0, FontFamily::Proportional),
            (TextStyle::Monospace, 13.0, FontFamily::Monospace),
            (TextStyle::Small, 11.5, FontFamily::Proportional),
        ];
        for (text, size, family) in sizes {
            style.text_styles.insert(text, FontId::new(size, family));
        }
        style.spacing.item_spacing = egui::vec2(8.0, 6.0);
        style.spacing.button_padding = egui::vec2(10.0, 5.0);
        style.spacing.interact_size.y = 26.0;
        style.spacing.slider_width = 130.0;
        style.interaction.selectable_labels = false;
        style.spacing.scroll = scroll();
    });
}

fn visuals(theme: Theme, palette: &Palette) -> Visuals {
    let mut visuals = match theme {
        Theme::Dark => Visuals::dark(),
        Theme::Light => Visuals::light(),
    };
    visuals.panel_fill = palette.back;
    visuals.window_fill = palette.card;
    visuals.extreme_bg_color = palette.card;
    visuals.override_text_color = Some(palette.text);
    visuals.selection.bg_fill = mixed(palette.target, palette.card, 0.45);
    visuals.selection.stroke = Stroke::new(1.0, palette.text);
    let control = mixed(palette.line, palette.card, 0.35);
    for (state, part) in [
        (&mut visuals.widgets.inactive, 0.0),
        (&mut visuals.widgets.hovered, 0.25),
        (&mut visuals.widgets.active, 0.45),
        (&mut visuals.widgets.open, 0.25),
    ] {
        state.corner_radius = CornerRadius::same(6);
        state.bg_fill = mixed(control, palette.target, part);
        state.weak_bg_fill = state.bg_fill;
        state.bg_stroke = Stroke::new(1.0, mixed(palette.line, palette.target, part));
        state.fg_stroke = Stroke::new(1.5, palette.text);
        state.expansion = 0.0;
    }
    visuals.widgets.noninteractive.bg_stroke = Stroke::new(1.0, palette.line);
    visuals.widgets.noninteractive.corner_radius = CornerRadius::same(8);
    visuals.slider_trailing_fill = true;
    visuals
}

#[cfg(test)]
#[path = "theme_tests.rs"]
mod tests;
