#!/usr/bin/env bash
# The test command. Without an argument it runs all that has to pass: packages, format, lints, every test, the fixture
# crate, documentation. `quick` runs what finds most faults within minutes, before a commit: it installs nothing and needs
# neither a driver nor a browser. It stops at the first failure, says before each part how many seconds have gone, and at
# the end how many each part took.
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
    cat >&2 <<'END'
usage: tests/run.sh [quick]
  without an argument: all that has to pass
  quick: format, unit tests, goldens, properties, the house and the catalogue, before a commit
END
    exit 2
}

names=()
seconds=()
part() {
    local name=$1 start=$SECONDS
    printf '\n== %s (%d s)\n' "$name" "$start"
    names+=("$name")
    "${@:2}"
    seconds+=($((SECONDS - start)))
}

table() {
    local status=$? i
    ((${#names[@]})) || return
    printf '\n'
    for i in "${!names[@]}"; do
        printf '%6s s  %s\n' "${seconds[i]:-failed}" "${names[i]}"
    done
    ((status)) || printf '\n== everything passed (%d s)\n' "$SECONDS"
}

quick() {
    part "format" cargo fmt --all --check
    part "unit tests" cargo test --quiet -p zonal-codegen --lib
    # Modules of the test program, which is compiled once for both; `catalog --check` would compile the generator again.
    local tests=(cargo test --quiet -p zonal-tests --test it --)
    part "goldens, properties, the house" \
        "${tests[@]}" goldens properties broken_families toy_language house citations
    part "catalogue" "${tests[@]}" catalog::the_catalogue_is_fresh
}

# NEON's registers are compiled for aarch64 and run in an emulator.
another_architecture() {
    local target=aarch64-unknown-linux-gnu
    [ -d "$(rustc --print target-libdir --target "$target")" ] || rustup target add "$target" || {
        echo "the target $target is missing: rustup target add $target" >&2
        return 1
    }
    CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc \
        CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER="qemu-aarch64 -L /usr/aarch64-linux-gnu" \
        cargo run --quiet --target "$target" -p zonal --no-default-features --features std,batch,order5 --example batches
}

whole() {
    local component
    for component in rustfmt clippy; do
        cargo "${component/rustfmt/fmt}" --version >/dev/null 2>&1 || rustup component add "$component"
    done
    part "packages" tests/install.sh
    part "format" cargo fmt --all --check
    part "lints" cargo clippy --quiet --workspace --all-targets -- -D warnings
    part "runtime without std" cargo check --quiet -p zonal --no-default-features \
        --features libm,all-orders,mint,serde,bytemuck
    part "generator without its checkers" cargo check --quiet -p zonal-codegen --no-default-features
    # Twice as many tests at once as there are processors: some wait for a compiler or a browser.
    part "batches on another architecture" another_architecture
    part "tests" env RUST_TEST_THREADS="${RUST_TEST_THREADS:-$((2 * $(nproc)))}" cargo test --workspace --no-fail-fast
    part "documentation" env RUSTDOCFLAGS="-D warnings" cargo doc --quiet --workspace --no-deps
}

case "$#:${1-}" in
    0:) run=whole ;;
    1:quick) run=quick ;;
    *) usage ;;
esac
command -v cargo >/dev/null || {
    echo "cargo is missing: install a Rust toolchain from https://rustup.rs, then run this again" >&2
    exit 1
}
trap table EXIT
"$run"
