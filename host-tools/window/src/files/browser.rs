//! In a browser: files are read later, and given back as a download.

use super::{Heap, put, put_too_large};
use eframe::egui::{Context, DroppedFileHandle};
use js_sys::{Array, Uint8Array};
use std::path::Path;
use std::rc::Rc;
use wasm_bindgen::JsCast;
use wasm_bindgen::JsValue;
use wasm_bindgen::closure::Closure;
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{Blob, Event, File, HtmlAnchorElement, HtmlElement, HtmlInputElement, Url};

pub(super) fn read(heap: &Heap, dropped: DroppedFileHandle, ctx: &Context) {
    if let Some(file) = dropped.web_file() {
        read_file(heap, file.clone(), ctx);
    }
}

fn read_file(heap: &Heap, file: File, ctx: &Context) {
    let name = file.name();
    if put_too_large(heap, &name, file.size()) {
        return;
    }
    let (heap, ctx) = (Rc::clone(heap), ctx.clone());
    spawn_local(async move {
        let read = JsFuture::from(file.array_buffer()).await;
        let bytes = read.map(|buffer| Uint8Array::new(&buffer).to_vec());
        put(&heap, &name, bytes.map_err(|error| words(&error.into())));
        ctx.request_repaint();
    });
}

fn words(error: &JsValue) -> String {
    let message = js_sys::Reflect::get(error, &"message".into());
    let message = message.ok().and_then(|message| message.as_string());
    message.unwrap_or_else(|| format!("{error:?}"))
}

pub(super) fn read_path(heap: &Heap, path: &Path) {
    let name = path.display().to_string();
    put(heap, &name, Err("a page reads no paths".into()));
}

/// The element stays until the user has chosen, or the page goes.
pub(super) fn choose(heap: &Heap, ctx: &Context) {
    let Some(input) = element::<HtmlInputElement>("input") else {
        return;
    };
    input.set_type("file");
    input.set_accept(".toml,text/plain");
    let (heap, ctx, chosen) = (Rc::clone(heap), ctx.clone(), input.clone());
    let on_change = Closure::once_into_js(move |_: Event| {
        if let Some(file) = chosen.files().and_then(|files| files.get(0)) {
            read_file(&heap, file, &ctx);
        }
    });
    input.set_onchange(Some(on_change.unchecked_ref()));
    input.click();
}

pub(super) fn save(name: &str, text: &str) -> Result<String, String> {
    let parts = Array::of1(&text.into());
    let blob = Blob::new_with_str_sequence(&parts).map_err(|error| words(&error))?;
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
