#!/usr/bin/env bash
# Makes the pictures of the documentation anew, with the program as it is.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build --release --locked
program=$PWD/target/release/ambray
cd docs/images
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

picture() { "$program" render atrium --size 640x360 --quiet -o "$@" >/dev/null; }
picture atrium.png
picture flat.png --radius 0.0001 --near-radiance off --filter off

# The hem of a curtain, as openness: without and with thin-object detection.
for thin in off sheet paper; do
  picture "$work/hem.png" --camera curtain-hem --aov openness --thin "$thin"
  mv "$work/hem.openness.png" "hem-$thin.png"
done

# The interleaved pattern before and after the filter, and the colours of the near field.
picture "$work/atrium.png" --aov openness,openness-raw,near-radiance --spp 8
mv "$work/atrium.openness-raw.png" openness-raw.png
mv "$work/atrium.openness.png" openness.png
mv "$work/atrium.near-radiance.png" near-radiance.png
