#!/bin/sh
# Promise R4: the runtime's tests under ThreadSanitizer and AddressSanitizer (with LeakSanitizer).
#
# A planted race must be reported in the same run; otherwise the absence of other reports proves nothing.
# The standard library is not instrumented, so ThreadSanitizer cannot see how `std::sync::Mutex`,
# `mpsc`, a join and the test harness synchronize threads. Three measures, none of which hides a race of ours:
# * it gets a program without harness and `mpsc`, which exercises all that threads share;
# * the runtime's one lock is taken from a crate (`--cfg tsan`), instrumented like everything else;
# * one suppression: `race:drop_slow`, the last drop of an `Arc`.
# AddressSanitizer does not have this problem and runs the whole test suite. Takes some minutes.
set -eu
cd "$(dirname "$0")/../.."
host=$(rustc -vV | sed -n 's/^host: //p')
target=${CARGO_TARGET_DIR:-target}/sanitizers
export RUSTC_BOOTSTRAP=1 DRAGONFLY_SANITIZER=1 DRAGONFLY_STRESS=${DRAGONFLY_STRESS:-400000} DRAGONFLY_OVERLOAD=1
suppressions=$(mktemp)
trap 'rm -f "$suppressions"' EXIT
echo 'race:drop_slow' >"$suppressions"

run() { # SANITIZER TEST ARGUMENTS...
    sanitizer=$1 test=$2
    shift 2
    lock=
    [ "$sanitizer" = address ] || lock='--cfg tsan'
    RUSTFLAGS="-Zsanitizer=$sanitizer -Cunsafe-allow-abi-mismatch=sanitizer $lock" \
        cargo test --quiet --locked --target "$host" --target-dir "$target/$sanitizer" -p dragonfly-runtime \
        --test "$test" -- "$@"
}

export TSAN_OPTIONS="halt_on_error=0 exitcode=66 suppressions=$suppressions"
if run thread models race >"$target-race.log" 2>&1 || ! grep -q 'data race' "$target-race.log"; then
    echo 'thread: the planted race is not reported' >&2
    tail -5 "$target-race.log" >&2
    exit 1
fi
echo "thread: the planted race is reported"
run thread models exercise
echo "thread: no race"
run address runtime
echo "address: no use after free, no leak"
