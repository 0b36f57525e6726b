#!/usr/bin/env bash
# The whole test command: packages, format, lints, every test, the fixture crate, documentation. It stops at the first
# failure, and says before each part how many seconds have gone.
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s (%d s)\n' "$1" "$SECONDS"; }

command -v cargo >/dev/null || {
    echo "cargo is missing: install a Rust toolchain from https://rustup.rs, then run this again" >&2
    exit 1
}
for part in rustfmt clippy; do
    cargo "${part/rustfmt/fmt}" --version >/dev/null 2>&1 || rustup component add "$part"
done

step "packages"
tests/install.sh
step "format"
cargo fmt --all --check
step "lints"
cargo clippy --quiet --workspace --all-targets -- -D warnings
step "runtime without std"
cargo check --quiet -p zonal --no-default-features --features libm
step "generator without its checkers"
cargo check --quiet -p zonal-codegen --no-default-features
step "tests"
cargo test --workspace --no-fail-fast
step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --quiet --workspace --no-deps
step "everything passed"
