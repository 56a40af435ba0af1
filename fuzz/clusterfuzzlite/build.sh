#!/usr/bin/env bash
# Builds the fuzz targets for ClusterFuzzLite. To be copied, with the files beside it, as the folder
# `.clusterfuzzlite` of a repository that has a folder `fuzz` in the layout of cargo-fuzz. Runs in the
# root of the repository, and writes each target's program, seeds and dictionary to the folder $OUT.
#
# FUZZ_BUILD is another command to build with than cargo-fuzz. With `fuzz/run build` neither cargo-fuzz
# nor a nightly toolchain is needed, but the programs have no address sanitizer.
set -euo pipefail
shopt -s nullglob

# Optimised programs have debug assertions only where these are asked for.
${FUZZ_BUILD:-cargo fuzz build --release --debug-assertions --all-features}

built=${CARGO_TARGET_DIR:-fuzz/target}/$(rustc -vV | sed -n 's/^host: //p')/release
for source in fuzz/fuzz_targets/*.rs; do
    target=$(basename "$source" .rs)
    if [[ ! -e $built/$target ]]; then
        # To measure coverage, the image builds without features.
        echo "$target was not built"
        continue
    fi
    cp "$built/$target" "$OUT/"
    seeds=("fuzz/corpus/$target"/* "fuzz/regressions/$target"/*)
    ((!${#seeds[@]})) || python3 -m zipfile -c "$OUT/${target}_seed_corpus.zip" "${seeds[@]}"
    dictionary=fuzz/dictionaries/$target.dict
    [[ ! -e $dictionary ]] || cp "$dictionary" "$OUT/"
done
