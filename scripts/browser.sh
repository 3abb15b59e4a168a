#!/usr/bin/env bash
# Installs what the tests of reports need, on Debian: Chromium, which shows them without a screen. Does nothing where there is
# one. Where it cannot be had, says so: the tests skip, unless AMBRAY_REQUIRE_BROWSER=1.
set -euo pipefail

give_up() {
  if [ "${AMBRAY_REQUIRE_BROWSER:-0}" = 1 ]; then
    echo "$1, and AMBRAY_REQUIRE_BROWSER=1" >&2
    exit 1
  fi
  echo "$1: the tests of reports in a browser are skipped"
  exit 0
}

for program in ${AMBRAY_BROWSER:-} chromium chromium-browser google-chrome google-chrome-stable chrome; do
  if command -v "$program" >/dev/null; then exit 0; fi
done

command -v apt-get >/dev/null || give_up "there is no apt to install Chromium"
echo "installing what the tests of reports need"
as_root() { if [ "$(id -u)" = 0 ]; then "$@"; else sudo DEBIAN_FRONTEND=noninteractive "$@"; fi; }
export DEBIAN_FRONTEND=noninteractive
[ "$(id -u)" = 0 ] || command -v sudo >/dev/null || give_up "installing needs root or sudo"
as_root apt-get update -qq || give_up "apt cannot be updated"
# A font comes with it, or pages would have no letters.
as_root apt-get install -y -qq --no-install-recommends chromium fonts-dejavu-core >/dev/null || give_up "apt has no chromium"
