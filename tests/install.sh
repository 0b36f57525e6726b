#!/usr/bin/env bash
# Installs what the tests on drivers and in a browser need, where it is missing: software Vulkan, two independent
# compilers, Chromium, Node and its one package; and what compiles and runs batches for aarch64. Where that is not possible it says what is missing and fails.
set -euo pipefail
cd "$(dirname "$0")/.."

# What shows that a package is there, and its name.
missing=()
need() { "${@:2}" >/dev/null 2>&1 || missing+=("$1"); }
need mesa-vulkan-drivers compgen -G '/usr/share/vulkan/icd.d/lvp_icd*.json'
need libvulkan1 compgen -G '/usr/lib/*/libvulkan.so.1'
need glslang-tools command -v glslangValidator
need spirv-tools command -v spirv-val
need chromium compgen -G '/usr/lib/chromium/vk_swiftshader_icd*.json'
need nodejs command -v node
need npm command -v npm
need qemu-user command -v qemu-aarch64
need gcc-aarch64-linux-gnu command -v aarch64-linux-gnu-gcc
need libc6-dev-arm64-cross test -e /usr/aarch64-linux-gnu/lib/libc.so.6

if ((${#missing[@]})); then
    install="apt-get install -y --no-install-recommends ${missing[*]}"
    fail() {
        echo "these packages are missing$1: $install" >&2
        exit 1
    }
    root=()
    ((EUID == 0)) || root=(sudo)
    for program in apt-get "${root[@]}"; do
        command -v "$program" >/dev/null || fail ", install them as root"
    done
    export DEBIAN_FRONTEND=noninteractive
    # shellcheck disable=SC2086
    "${root[@]}" apt-get update -qq && "${root[@]}" $install -qq || fail " and could not be installed"
fi

if ! [ tests/browser/node_modules/.package-lock.json -nt tests/browser/package-lock.json ]; then
    npm ci --prefix tests/browser --no-audit --no-fund || {
        echo "tests/browser lacks its package: npm ci --prefix tests/browser" >&2
        exit 1
    }
fi
