#!/usr/bin/env bash
# Runs `sunfleck bench` as a user would: what is right must work, and what is wrong must end with status 2 and one line
# on stderr, and leave nothing behind. Usage: bench_command_line.sh PATH_TO_SUNFLECK
source "$(dirname "$0")/as_a_user.bash" "$1"

: >empty
refuses "folder" bench slab -o empty/folder
refuses "frobnicate" bench frobnicate
refuses "must not be empty" bench slab -o ""
refuses "nosuch" bench directions nosuch -o dirs
refuses "whole number, 16 to 50000" bench stand --trees 15 -o dirs
refuses "must not be empty" bench stand -o ""
refuses "nosuch" bench scene nosuch -o dirs
refuses "--reference" bench scene leaf.obj --reference 63 -o dirs
refuses "--paths" bench scene leaf.obj --paths 1e3 nan -o dirs
refuses "fewer than the reference's" bench scene leaf.obj --reference 1e3 --paths 1e3 -o dirs
refuses "given once" bench scene leaf.obj --paths 1e3 1e3 -o dirs
refuses "whole number, 1 to 1000" bench scene leaf.obj --rounds 0 -o dirs
refuses "0, 1 or 2" bench scene leaf.obj --band 3 -o dirs
refuses "must not be empty" bench scene leaf.obj -o ""
refuses "enough to compare" bench scene leaf.obj --reference 1e3 -o dirs
refuses "nosuch" bench pictures nosuch -o dirs
refuses "must be named once" bench pictures cherry cherry -o dirs
refuses "whole number, 2 to 65536" bench pictures --samples 1 -o dirs
refuses "--trees" bench stand --trees 1e1 -o dirs
does "nstreamg" bench pictures leaf.obj -o benches --samples 2 --size 40 30 --field-of-view 40 --quiet
[ -s benches/picture_bench_leaf.png ] && grep -q "^leaf,sppg," benches/picture_bench.csv || fail "bench pictures: files"
"$program" plant random_crown --leaves 400 -o crown.ply >/dev/null || fail "a crown for bench scene"
does "crosses Monte Carlo" bench scene crown.ply --reference 1e4 --paths 1e2 1e3 --rounds 1 -o benches --quiet
does '"monte_carlo_cpu_seconds"' bench scene crown.ply --reference 1e4 --rounds 1 -o benches --quiet --json
grep -q "^monte_carlo,2500," benches/scene_bench.csv && [ -s benches/scene_bench.svg ] || fail "bench scene: files"
does "cherry" bench stand --trees 16 --rounds 1 -o benches --quiet
does '"move_tree_seconds"' bench stand --trees 16 --rounds 1 -o benches --quiet --json
refuses "whole number, 1 to 100" bench stand --rounds 0 -o dirs
# What is interrupted leaves no empty folder.
set -m  # or what runs behind does not hear of Ctrl-C
"$program" bench slab -o empty_bench/folder --quiet >/dev/null 2>stderr.txt &
for _ in $(seq 300); do [ -e empty_bench/folder ] && break; sleep 0.1; done
kill -INT $!
wait $!
[ $? -eq 1 ] || fail "bench slab, interrupted: not status 1: $(head -c 400 stderr.txt)"
[ ! -e empty_bench ] || fail "bench slab, interrupted: left a folder"
"$program" bench scene cherry -o empty_bench/folder --quiet >/dev/null 2>stderr.txt &
for _ in $(seq 300); do [ -e empty_bench/folder ] && break; sleep 0.1; done
kill -INT $!
wait $!
[ $? -eq 1 ] || fail "bench scene, interrupted: not status 1: $(head -c 400 stderr.txt)"
[ ! -e empty_bench ] || fail "bench scene, interrupted: left a folder"
set +m

conclude
