#!/usr/bin/env bash
# Everything that must hold: formatting, lints, documentation, tests, examples. On Debian it installs what it needs.
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s\n' "$*"; }

# NVIDIA's FLIP, by which pictures are compared, is C++.
if ! command -v c++ >/dev/null; then
  step "installing a C++ compiler for the picture metrics"
  sudo=$([ "$(id -u)" = 0 ] || echo sudo)
  $sudo apt-get update -qq
  $sudo apt-get install -y -qq --no-install-recommends g++
fi

# Lavapipe stands in for a graphics card, so that the tests of the Vulkan backend run everywhere and the same. With
# AMBRAY_VULKAN=hardware they run on the device that the system prefers.
scripts/vulkan.sh
if [ "${AMBRAY_VULKAN:-lavapipe}" != hardware ] && [ -z "${VK_DRIVER_FILES:-}" ]; then
  lavapipe=$(compgen -G '/usr/share/vulkan/icd.d/lvp_icd*.json' | head -n 1 || true)
  if [ -n "$lavapipe" ]; then export VK_DRIVER_FILES=$lavapipe; fi
fi

# The window's tests open it on a screen in memory.
scripts/view.sh

# The tests of reports open them in a browser.
scripts/browser.sh

step "formatting"
if cargo fmt --version >/dev/null 2>&1; then cargo fmt --all --check; else echo "skipped: no rustfmt"; fi

step "lints"
if cargo clippy --version >/dev/null 2>&1; then
  cargo clippy --workspace --all-targets --locked --quiet -- -D warnings
else
  echo "skipped: no clippy"
fi

step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked --quiet

step "tests"
cargo test --workspace --locked

step "the program, as a newcomer runs it"
cargo build --release --locked
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
program=$PWD/target/release/ambray
(cd "$folder" && "$program" && test -s ambray.png)
echo "all is well"
