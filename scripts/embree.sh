#!/usr/bin/env bash
# Ambray's tracer beside Embree on the same triangles and rays: a table of rates and ratios.
#
#   ambray bench Sponza.gltf --rays nave --rounds 0 ...          # writes triangles and rays to the folder nave
#   scripts/embree.sh [OPTIONS] EMBREE_BENCH FOLDER...
#
# EMBREE_BENCH is the program that traces such files with Embree, or its C++ source, which is built with g++ and -lembree4
# or -lembree3. Embree is no part of Ambray: install it (Debian: libembree-dev) or point CPATH and LIBRARY_PATH to it.
# Nothing is downloaded.
set -euo pipefail

usage() {
  sed -n '2,9s/^# \{0,1\}//p' "$0"
  cat <<'END'

  --rounds N       rounds in which everything is run in turn [5]
  --inner N        rounds within each run of a program, of which the median counts [3]
  --threads N      threads of both [1]
  --batches LIST   files of rays to trace, without .rays [all]
  --isa LIST       instruction sets of Ambray [all that the machine has]
  --quality LIST   trees of Ambray [balanced,best-trace]
  --builds N       builds of each kind to measure, 0 for none [3]
  --json FILE      write the numbers there too
  --keep FOLDER    keep what the programs said

The program of Ambray is the one named by $AMBRAY, else target/release/ambray, built if it is missing.
END
}

die() { echo "embree.sh: $*" >&2; exit 2; }

rounds=5 inner=3 threads=1 batches= isa= quality=balanced,best-trace builds=3 json= keep=
while [[ ${1:-} == -* ]]; do
  case $1 in
    -h | --help) usage; exit 0 ;;
    --rounds | --inner | --threads | --batches | --isa | --quality | --builds | --json | --keep)
      [ $# -ge 2 ] || die "$1 needs a value"
      printf -v "${1#--}" %s "$2"
      shift 2 ;;
    *) die "there is no option $1: see --help" ;;
  esac
done
[ $# -ge 2 ] || { usage >&2; exit 2; }
embree=$1
shift
command -v python3 >/dev/null || die "python3 is needed: it makes the table"
[ -e "$embree" ] || die "$embree does not exist"
here=$(cd "$(dirname "$0")" && pwd)

work=${keep:-$(mktemp -d)}
mkdir -p "$work"
# What an earlier run left there would get into the table.
[ -z "$(ls -A "$work")" ] || die "$work is not empty: --keep needs a folder of its own"
[ -n "$keep" ] || trap 'rm -rf "$work"' EXIT

# Builds a source with the newest Embree there is.
build() {
  local library
  command -v g++ >/dev/null || die "g++ is needed to build $1"
  for library in embree4 embree3; do
    if g++ -O3 -march=native -std=c++17 "$1" -o "$2" -l$library -lpthread 2>"$work/$library.log"; then return; fi
  done
  cat "$work"/embree?.log >&2
  die "$1 cannot be built: install Embree (Debian: libembree-dev), or set CPATH and LIBRARY_PATH to where it is"
}

case $embree in
  *.cpp | *.cc) build "$embree" "$work/embree_bench"; embree=$work/embree_bench ;;
  *) [ -x "$embree" ] || die "$embree is neither a C++ source nor a program" ;;
esac

ambray=${AMBRAY:-}
if [ -z "$ambray" ]; then
  ambray=${CARGO_TARGET_DIR:-$here/../target}/release/ambray
  [ -x "$ambray" ] || (cd "$here/.." && cargo build --release --locked -p ambray_cli --no-default-features)
fi

ours=(--json --threads "$threads" --quality "$quality")
if [ -n "$isa" ]; then ours+=(--isa "$isa"); fi

run=0
for folder in "$@"; do
  [ -s "$folder/scene.tris" ] || die "$folder has no scene.tris: write it with ambray bench SCENE --rays $folder"
  run=$((run + 1))
  place=$work/$run
  mkdir -p "$place/hits"
  echo "$folder" >"$place/folder"
  if [ -n "$batches" ]; then
    names=${batches//,/ }
  else
    names=$(cd "$folder" && for file in *.rays; do echo "${file%.rays}"; done)
  fi
  for name in $names; do
    rays=$folder/$name.rays
    [ -s "$rays" ] || die "$rays does not exist"
    # The third number after the magic word: 0 closest hit, 1 any hit.
    kind=$([ "$(od -An -t u4 -j 12 -N 4 "$rays" | tr -d ' ')" = 1 ] && echo any || echo closest)
    for round in $(seq "$rounds"); do
      echo "$folder, $name, round $round of $rounds" >&2
      # The hits that are compared are those of the last.
      for tree in medium high; do
        "$embree" "$folder/scene.tris" "$rays" "$threads" "$inner" $tree $kind "$place/hits/$name.hits" \
          >"$place/embree.$name.$round.$tree.txt"
      done
      "$ambray" bench --rays "$folder" --batches "$name" --rounds "$inner" --builds 0 "${ours[@]}" \
        --check-hits "$place/hits" >"$place/ambray.$name.$round.json"
    done
  done
  if [ "$builds" -gt 0 ]; then
    echo "$folder, builds" >&2
    if [ ! -x "$work/embree_build" ]; then build "$here/embree/build.cpp" "$work/embree_build"; fi
    "$work/embree_build" "$folder/scene.tris" "$threads" "$builds" >"$place/embree.builds.json"
    "$ambray" bench --rays "$folder" --rounds 0 --builds "$builds" "${ours[@]}" >"$place/ambray.builds.json"
  fi
done
python3 "$here/embree/table.py" "$work" ${json:+"$json"}
