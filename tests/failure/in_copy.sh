#!/bin/sh
# Usage: in_copy.sh ROOT PATCH TARGET COMMAND ARGUMENT...
# Runs a command under ROOT after a patch was seeded and a ninja target built, in a mount namespace of its own:
# what is written to ROOT goes to memory and is gone with the last process. The build in ROOT is taken as it is,
# so only what the patch changes is built again. PATCH and TARGET may be empty.
# What the build says is shown only when it fails. Exits with the command's status, or 101 when there is no copy,
# 102 when the patch does not apply, 103 when the target does not build.
root=$1 patch=$2 target=$3
shift 3

writable=$(mktemp -d) && trap 'umount -l "$writable"; rmdir "$writable"' EXIT || exit 101
mount -t tmpfs tmpfs "$writable" && mkdir "$writable/upper" "$writable/work" || exit 101
mount -t overlay overlay -o "lowerdir=$root,upperdir=$writable/upper,workdir=$writable/work" "$root" || exit 101
cd "$root" || exit 101
[ -z "$patch" ] || git apply "$patch" || exit 102
if [ -n "$target" ]; then
  ninja -C build/release "$target" >"$writable/log" 2>&1 || { cat "$writable/log"; exit 103; }
fi
"$@"
