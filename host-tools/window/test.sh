#!/usr/bin/env bash
# Builds the window for a browser, exports it, and does in a browser what a user does: from nothing but Rust, where apt may
# install the browser.
#
#     test.sh                everything
#     test.sh --page DIR     only what a browser shows of the page in DIR, in browsers beside each other: what CI runs
set -euo pipefail
page=target/site
beside=()
if [ "${1:-}" = --page ]; then
    page=$(realpath "$2")
    beside=(--beside)
fi
# The program may be named from where this was called.
if [ -n "${LEG:-}" ]; then
    LEG=$(realpath "$LEG")
    export LEG
fi
cd "$(dirname "$0")"

# The build flags are those of .cargo/config.toml: a variable of the environment would replace them in silence.
unset RUSTFLAGS CARGO_ENCODED_RUSTFLAGS
for program in chromium chromedriver python3; do
    command -v "$program" >/dev/null && continue
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends chromium chromium-driver python3
    break
done

if [ ${#beside[@]} -eq 0 ]; then
    rustup target list --installed | grep -q '^wasm32-unknown-unknown$' || rustup target add wasm32-unknown-unknown
    cargo test --locked --no-default-features --lib
    cargo run --locked --package leg-window-export -- "$page"
fi
if [ -z "${LEG:-}" ]; then
    (cd ../.. && cargo build --locked --bin leg)
fi
python3 tests/browser.py "$page" "${beside[@]}"
python3 tests/live.py "$page"
