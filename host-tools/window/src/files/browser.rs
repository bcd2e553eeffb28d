//! In a browser: files are read later, and given back as a download.

use super::Files;
use egui::{Context, DroppedFileHandle};
use js_sys::{Array, Uint8Array};
use std::path::Path;
use wasm_bindgen::JsCast;
use wasm_bindgen::JsValue;
use wasm_bindgen::closure::Closure;
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{Blob, Event, File, HtmlAnchorElement, HtmlElement, HtmlInputElement, Url};

pub(super) fn read(files: &Files, dropped: DroppedFileHandle, ctx: &Context) {
    if let Some(file) = dropped.web_file() {
        read_file(files, file.clone(), ctx);
    }
}

fn read_file(files: &Files, file: File, ctx: &Context) {
    let name = file.name();
    if files.put_too_large(&name, file.size()) {
        return;
    }
    let (files, ctx) = (files.clone(), ctx.clone());
    spawn_local(async move {
        let read = JsFuture::from(file.array_buffer()).await;
        let bytes = read.map(|buffer| Uint8Array::new(&buffer).to_vec());
        files.put(&name, bytes.map_err(|error| words(&error)));
        ctx.request_repaint();
    });
}

fn words(error: &JsValue) -> String {
    let message = js_sys::Reflect::get(error, &"message".into());
    let message = message.ok().and_then(|message| message.as_string());
    message.unwrap_or_else(|| format!("{error:?}"))
}

pub(super) fn read_path(files: &Files, path: &Path) {
    let name = path.display().to_string();
    files.put(&name, Err("a page reads no paths".into()));
}

/// The element stays until the user has chosen, or the page goes.
pub(super) fn choose(files: &Files, ctx: &Context) {
    let Some(input) = element::<HtmlInputElement>("input") else {
        return;
    };
    input.set_type("file");
    input.set_accept(files.kind.accepted());
    let (files, ctx, chosen) = (files.clone(), ctx.clone(), input.clone());
    let on_change = Closure::once_into_js(move |_: Event| {
        if let Some(file) = chosen.files().and_then(|files| files.get(0)) {
            read_file(&files, file, &ctx);
        }
    });
    input.set_onchange(Some(on_change.unchecked_ref()));
    input.click();
}

pub(super) fn save(name: &str, bytes: &[u8]) -> Result<String, String> {
    let parts = Array::of1(&Uint8Array::from(bytes));
    let blob = Blob::new_with_u8_array_sequence(&parts).map_err(|error| words(&error))?;
    let address = Url::create_object_url_with_blob(&blob).map_err(|error| words(&error))?;
    let anchor = element::<HtmlAnchorElement>("a").ok_or("the browser has no document")?;
    anchor.set_href(&address);
    anchor.set_download(name);
    anchor.unchecked_ref::<HtmlElement>().click();
    // The browser has taken the address by now.
    let _ = Url::revoke_object_url(&address);
    Ok(format!("{name} is among the browser's downloads."))
}

fn element<T: JsCast>(kind: &str) -> Option<T> {
    let document = web_sys::window()?.document()?;
    document.create_element(kind).ok()?.dyn_into().ok()
}
