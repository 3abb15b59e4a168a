#!/usr/bin/env bash
# Counts the instructions of a small frame, which do not depend on what else the machine does, and compares them with the
# record in docs/instructions.json.
#
#   scripts/instructions.sh              compare; exit code 1 if a frame or the trees take 2 % more than recorded
#   scripts/instructions.sh --record     write the record anew
#
# Needs valgrind (Debian: apt-get install valgrind) and python3. The program is the one named by $AMBRAY, else it is built.
# Valgrind knows no AVX-512, so the kernels are those of AVX2.
set -euo pipefail
cd "$(dirname "$0")/.."

die() { echo "instructions.sh: $*" >&2; exit 2; }
case ${1:-} in
  "" | --record) ;;
  *) sed -n '2,9s/^# \{0,1\}//p' "$0"; exit 2 ;;
esac
command -v valgrind >/dev/null || die "valgrind is needed (Debian: apt-get install valgrind)"
command -v python3 >/dev/null || die "python3 is needed"

ambray=${AMBRAY:-}
if [ -z "$ambray" ]; then
  cargo build --release --locked -p ambray_cli --no-default-features
  ambray=${CARGO_TARGET_DIR:-target}/release/ambray
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# A frame is what a run of three has more than a run of one, half of it: loading and building fall out.
frame=(bench atrium --backend cpu --isa avx2 --threads 1 --size 96x54 --spp 8 --thin sheet --packets always --warmup 0 --quiet)
for frames in 1 3; do
  valgrind --quiet --tool=callgrind --callgrind-out-file="$work/$frames.out" "$ambray" "${frame[@]}" --frames "$frames" \
    >/dev/null 2>"$work/$frames.log" || { cat "$work/$frames.log" >&2; die "the program failed under valgrind"; }
done
python3 scripts/instructions/count.py "$work/1.out" "$work/3.out" docs/instructions.json "$(rustc -V)" "${frame[*]}" "${1:-}"
