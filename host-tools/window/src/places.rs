//! Where the controls are on the screen: a test that presses them asks for it.

use egui::{Context, Id, Rect, Response};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The controls of a frame, by their names.
#[derive(Clone, Debug, Default)]
pub struct Places {
    /// Where they were drawn, points.
    pub rects: BTreeMap<Cow<'static, str>, Rect>,
    /// The one that has the keyboard's focus.
    pub focused: Option<Cow<'static, str>>,
}

fn id() -> Id {
    Id::unique("places of the controls")
}

fn change(ctx: &Context, change: impl FnOnce(&mut Places)) {
    ctx.data_mut(|data| change(data.get_temp_mut_or_default::<Places>(id())));
}

/// Notes where a control is.
pub fn place(response: &Response, name: impl Into<Cow<'static, str>>) {
    let name = name.into();
    let focused = response.has_focus();
    change(&response.ctx, |places| {
        places.rects.insert(name.clone(), response.rect);
        if focused {
            places.focused = Some(name);
        }
    });
}

/// Notes where something is that is no control.
pub fn place_rect(ctx: &Context, rect: Rect, name: &'static str) {
    change(ctx, |places| {
        places.rects.insert(name.into(), rect);
    });
}

/// Where all of them are; they are noted anew in the next frame.
#[must_use]
pub fn take(ctx: &Context) -> Places {
    ctx.data_mut(|data| data.remove_temp(id()).unwrap_or_default())
}
