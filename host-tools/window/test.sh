#!/usr/bin/env bash
# Builds the window for a browser, exports it, and does in a browser what a user does: from nothing but Rust, where apt may
# install the browser.
set -euo pipefail
cd "$(dirname "$0")"

# The build flags are those of .cargo/config.toml: a variable of the environment would replace them in silence.
unset RUSTFLAGS CARGO_ENCODED_RUSTFLAGS
for program in chromium chromedriver python3; do
    command -v "$program" >/dev/null && continue
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends chromium chromium-driver python3
    break
done
rustup target list --installed | grep -q '^wasm32-unknown-unknown$' || rustup target add wasm32-unknown-unknown

cargo test --locked
cargo run --release --locked --package leg-window-export -- target/site
python3 tests/browser.py target/site
if [ -z "${LEG:-}" ]; then
    (cd ../.. && cargo build --locked --bin leg)
fi
python3 tests/live.py target/site
