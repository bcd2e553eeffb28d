#!/usr/bin/env bash
# Does what README.md says, and tests the package: from nothing but Rust and a C compiler, where apt may install Python.
set -euo pipefail
cd "$(dirname "$0")"

# The build flags are those of .cargo/config.toml: a variable of the environment would replace them in silence.
unset RUSTFLAGS CARGO_ENCODED_RUSTFLAGS
if ! python3 -c 'import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 11))'; then
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends python3 python3-venv
fi

# The blocks of a language in README.md.
blocks() { sed -n "/^\`\`\`$1\$/,/^\`\`\`\$/{/^\`\`\`/d;p}" README.md; }

# An environment that was copied from elsewhere would install there.
rm -rf .venv
rm -f circle.png
from_clone=$(blocks sh)
# From a clone to the chart of the circle.
(($(wc -l <<<"$from_clone") <= 10))
(cd ../.. && bash -euxc "$from_clone")
test -s circle.png
blocks python | .venv/bin/python -W error -
.venv/bin/python -m mypy --strict python/tendon_leg examples
# Most of them wait: for a leg that runs in real time, or for another process.
.venv/bin/python -W error -m pytest -q -n $((2 * $(nproc)))
