//! Where the controls are on the screen: a test that presses them asks for it.

use eframe::egui::{Context, Id, Rect, Response};
use std::collections::BTreeMap;

/// Names of controls, and where they were drawn last, points.
pub type Places = BTreeMap<&'static str, Rect>;

fn id() -> Id {
    Id::unique("places of the controls")
}

/// Notes where a control is.
pub fn place(response: &Response, name: &'static str) {
    let rect = response.rect;
    response.ctx.data_mut(|data| {
        data.get_temp_mut_or_default::<Places>(id())
            .insert(name, rect);
    });
}

/// Where all of them are; they are noted anew in the next frame.
#[must_use]
pub fn take(ctx: &Context) -> Places {
    ctx.data_mut(|data| data.remove_temp(id()).unwrap_or_default())
}
