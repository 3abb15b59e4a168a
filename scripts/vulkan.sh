#!/usr/bin/env bash
# Installs what the tests of the Vulkan backend need, on Debian: the loader, the validation layer, and Mesa's lavapipe, a
# device in software, from 25.0 on: older ones do not trace rays. Does nothing where all of it is there. Where it cannot be
# had, says so: the tests skip, unless AMBRAY_REQUIRE_VULKAN=1. With AMBRAY_VULKAN=hardware, lavapipe is not wanted.
set -euo pipefail

least=25.0
driver=mesa-vulkan-drivers
packages=(libvulkan1 vulkan-validationlayers)

give_up() {
  if [ "${AMBRAY_REQUIRE_VULKAN:-0}" = 1 ]; then
    echo "$1, and AMBRAY_REQUIRE_VULKAN=1" >&2
    exit 1
  fi
  echo "$1: the tests of the Vulkan backend are skipped"
  exit 0
}

installed() { dpkg-query -W -f '${db:Status-Status} ${Version}\n' "$1" 2>/dev/null | sed -n 's/^installed //p' | head -n 1; }
is_enough() { [ -n "$1" ] && dpkg --compare-versions "$1" ge "$least"; }
# The version that apt would install, and the newest that it knows of.
candidate() { apt-cache policy "$driver" | sed -n 's/^ *Candidate: //p' | grep -vx '(none)' || true; }
newest() { apt-cache madison "$driver" | cut -d '|' -f 2 | tr -d ' ' | sort -V | tail -n 1; }

wants_driver=true
[ "${AMBRAY_VULKAN:-lavapipe}" = hardware ] && wants_driver=false

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  # Who has no apt may have a driver all the same: the tests find out.
  compgen -G '/usr/share/vulkan/icd.d/lvp_icd*.json' >/dev/null || ! $wants_driver || give_up "there is no apt to install lavapipe"
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  [ -n "$(installed "$package")" ] || missing+=("$package")
done
needs_driver=false
if $wants_driver && ! is_enough "$(installed "$driver")"; then needs_driver=true; fi
if [ ${#missing[@]} = 0 ] && ! $needs_driver; then exit 0; fi

echo "installing what the tests of the Vulkan backend need"
as_root() { if [ "$(id -u)" = 0 ]; then "$@"; else sudo DEBIAN_FRONTEND=noninteractive "$@"; fi; }
export DEBIAN_FRONTEND=noninteractive
install() { as_root apt-get install -y -qq --no-install-recommends "$@" >/dev/null; }

[ "$(id -u)" = 0 ] || command -v sudo >/dev/null || give_up "installing needs root or sudo"
as_root apt-get update -qq || give_up "apt cannot be updated"
[ ${#missing[@]} = 0 ] || install "${missing[@]}" || give_up "apt has no ${missing[*]}"
$needs_driver || exit 0

codename=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
backports=$codename-backports
if ! is_enough "$(newest)" && [ -n "$codename" ]; then
  # From where the release itself comes. Hosts that only have security updates or other suites do not serve backports.
  mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' "Codename: $codename" 'Component: main' |
    head -n 1)
  [ -n "$mirror" ] || give_up "$driver $least is not to be had, and apt knows no mirror of $codename"
  keyring=/usr/share/keyrings/debian-archive-keyring.gpg
  sources=/etc/apt/sources.list.d/ambray-backports.sources
  printf 'Types: deb\nURIs: %s\nSuites: %s\nComponents: main\n' "$mirror" "$backports" | as_root tee "$sources" >/dev/null
  [ ! -e "$keyring" ] || echo "Signed-By: $keyring" | as_root tee -a "$sources" >/dev/null
  if ! as_root apt-get update -qq || ! is_enough "$(newest)"; then
    as_root rm -f "$sources"
    as_root apt-get update -qq || true
    give_up "$driver $least is not to be had"
  fi
fi
if is_enough "$(candidate)"; then
  install "$driver" || give_up "$driver cannot be installed"
else
  # What it depends on may have to be newer, too.
  install -t "$backports" "$driver" || give_up "$driver of $backports cannot be installed"
fi
is_enough "$(installed "$driver")" || give_up "$driver $least is not to be had"
