#!/usr/bin/env bash
# Installs what the tests of the window need, on Debian: Xvfb, a screen in memory, and the libraries that windows are loaded
# with when the program runs. Does nothing where all of it is there. Where it cannot be had, says so: the tests skip, unless
# AMBRAY_REQUIRE_WINDOW=1.
set -euo pipefail

packages=(xvfb libx11-6 libx11-xcb1 libxcb1 libxcursor1 libxi6 libxkbcommon0 libxkbcommon-x11-0 libegl1 libgl1 libgl1-mesa-dri libgles2)

give_up() {
  if [ "${AMBRAY_REQUIRE_WINDOW:-0}" = 1 ]; then
    echo "$1, and AMBRAY_REQUIRE_WINDOW=1" >&2
    exit 1
  fi
  echo "$1: the tests of the window are skipped"
  exit 0
}

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  # Who has no apt may have a display all the same: the tests find out.
  command -v Xvfb >/dev/null || give_up "there is no apt to install Xvfb"
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  state=$(dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null | head -n 1 || true)
  [ "$state" = installed ] || missing+=("$package")
done
if [ ${#missing[@]} = 0 ]; then exit 0; fi

echo "installing what the tests of the window need"
as_root() { if [ "$(id -u)" = 0 ]; then "$@"; else sudo DEBIAN_FRONTEND=noninteractive "$@"; fi; }
export DEBIAN_FRONTEND=noninteractive
[ "$(id -u)" = 0 ] || command -v sudo >/dev/null || give_up "installing needs root or sudo"
as_root apt-get update -qq || give_up "apt cannot be updated"
as_root apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null || give_up "apt has no ${missing[*]}"
