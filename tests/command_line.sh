#!/usr/bin/env bash
# Runs the program as a user would: what is right must work, and what is wrong must end with status 2 and one line on
# stderr, and leave nothing behind. Usage: command_line.sh PATH_TO_SUNFLECK
set -u
program=$(readlink -f "$1")
place=$(mktemp -d)
trap 'rm -rf "$place" "$place.before"' EXIT
cd "$place" || exit 1
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }

# refuses WHAT_THE_MESSAGE_MUST_HOLD ARGUMENTS...
refuses() {
  local expected=$1; shift
  find . | sort >"$place.before"
  "$program" "$@" >stdout.txt 2>stderr.txt </dev/null
  local status=$?
  [ $status -eq 2 ] || fail "$* : status $status, not 2: $(head -c 400 stderr.txt)"
  [ "$(wc -l <stderr.txt)" -eq 1 ] || fail "$* : not one line on stderr: $(head -c 600 stderr.txt)"
  grep -qiF -- "$expected" stderr.txt || fail "$* : \"$expected\" is not in: $(cat stderr.txt)"
  [ ! -s stdout.txt ] || fail "$* : wrote to stdout: $(head -c 200 stdout.txt)"
  rm -f stdout.txt stderr.txt
  diff <(find . | sort) "$place.before" >/dev/null || fail "$* : left something behind: $(find . | tr '\n' ' ')"
  rm -f "$place.before"
}
# does WHAT_STDOUT_MUST_HOLD ARGUMENTS...
does() {
  local expected=$1; shift
  "$program" "$@" >stdout.txt 2>stderr.txt </dev/null
  local status=$?
  [ $status -eq 0 ] || fail "$* : status $status: $(head -c 600 stderr.txt)"
  grep -qF -- "$expected" stdout.txt || fail "$* : \"$expected\" is not in: $(head -c 600 stdout.txt)"
  [ ! -s stderr.txt ] || fail "$* : wrote to stderr: $(head -c 600 stderr.txt)"
  rm -f stdout.txt stderr.txt
}

square='v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n'
printf "$square"'usemtl leaf\nf 1 2 3 4\n' >leaf.obj
printf "$square"'usemtl leaf\nf 1 2 3 4\nf 1 1 2\nusemtl bark\nf 1 2 3\n' >flat.obj
printf "$square"'usemtl bark\nf 1 2 3 4\n' >wood.obj
printf 'v nan 0 1\nv 1 0 1\nv 1 1 1\nusemtl leaf\nf 1 2 3\n' >nan.obj
printf 'v inf 0 1\nv 1 0 1\nv 1 1 1\nusemtl leaf\nf 1 2 3\n' >inf.obj
printf "$square"'usemtl leaf\nf 1 2 9\n' >range.obj
printf "$square"'usemtl leaf\nf 1 1 2\n' >only_flat.obj
printf "$square"'usemtl whatever\nf 1 2 3 4\n' >unknown.obj
: >empty.obj
: >empty.vdb
seq 1 700 | tr '0-9\n' '\000-\011\377' >garbage.obj
cp garbage.obj garbage.vdb
mkdir folder folder.toml
printf '[sun]\nzenit_deg = 3\n' >unknown_key.toml
printf '[sun]\nzenith_deg = "high"\n' >wrong_type.toml
printf '[sun]\nzenith_deg = 95\n' >out_of_range.toml
printf '[sun\n' >broken.toml
printf '[tree]\nfile = "none.obj"\n' >missing_mesh.toml
printf 'g,omega,thickness,mu0\n0,0.9,1\n' >short.csv
printf 'g,omega,thickness,mu0\n0,0.9,-1,1\n' >negative.csv

for command in validate trace voxelize plant; do
  out=(); [ $command = voxelize ] && out=(-o out.vdb); [ $command = plant ] && out=(-o out.obj)
  refuses "missing.obj" $command missing.obj "${out[@]}"
  refuses "empty.obj" $command empty.obj "${out[@]}"
  refuses "nan.obj" $command nan.obj "${out[@]}"
  refuses "inf.obj" $command inf.obj "${out[@]}"
  refuses "range.obj" $command range.obj "${out[@]}"
  refuses "only_flat.obj" $command only_flat.obj "${out[@]}"
  refuses "wood.obj" $command wood.obj "${out[@]}"
  refuses "unknown.obj" $command unknown.obj "${out[@]}"
  refuses "garbage.obj" $command garbage.obj "${out[@]}"
done
refuses "folder" plant folder/x.obj
refuses "--frobnicate" validate --frobnicate
refuses "frobnicate" frobnicate
refuses "--albedo" validate leaf.obj --albedo 1.5
refuses "--albedo" trace leaf.obj --albedo -0.1
refuses "--albedo" render leaf.obj -o x.png --albedo nan
refuses "thickness" slab --thickness -1
refuses "omega" slab --omega 2
refuses "g = 1" slab --g 1
refuses "mu0" slab --mu0 0
refuses "needs -o" slab-table
refuses "missing.sft" slab-table missing.sft
refuses "garbage.vdb: is no table of slabs" slab-table garbage.vdb
refuses ".sft" slab-table -o out.bin
refuses "--omega" slab-table --omega 1.1 -o out.sft
refuses "reflectance + transmittance" slab-table --leaves spherical --reflectance 0.9 --transmittance 0.9 -o out.sft
refuses "--leaves" slab-table --omega 0.5 --leaves spherical -o out.sft
refuses "max_error" slab-table --max-error 1e-9 -o out.sft
refuses "there is no folder" slab-table -o nowhere/out.sft
does "error bound" slab-table --omega 0.5 --max-thickness 1 --max-error 0.3 --streams 8 -o out.sft
does '"medium": "Henyey-Greenstein particles, omega 0.5, g 0"' slab-table out.sft --json
head -c 1000 out.sft >cut.sft
refuses "cut.sft: is cut short" slab-table cut.sft
refuses "nowhere" voxelize leaf.obj -o nowhere/x.vdb
refuses "nowhere" render leaf.obj -o nowhere/x.png
refuses "folder" plant leaf.obj -o folder
refuses ".jpg" render leaf.obj -o x.jpg
refuses "empty.vdb" voxelize empty.vdb
refuses "garbage.vdb" voxelize garbage.vdb
refuses "missing.vdb" voxelize missing.vdb
refuses "--cell-size" voxelize leaf.obj -o x.vdb --cell-size 0
refuses "cell" voxelize leaf.obj -o x.vdb --cell-size 1e-6
refuses "unknown_key.toml:2" trace unknown_key.toml
refuses "wrong_type.toml:2" trace wrong_type.toml
refuses "out_of_range.toml:2" trace out_of_range.toml
refuses "broken.toml:1" trace broken.toml
refuses "none.obj" trace missing_mesh.toml
refuses "missing.toml" trace missing.toml
refuses "no-such-scene" trace no-such-scene
refuses "short.csv:2" slab --batch short.csv
refuses "negative.csv:2" slab --batch negative.csv
refuses "species" plant --species baobab
refuses "--species" plant leaf.obj --species maple
refuses ".csv" trace leaf.obj -o x.png
refuses ".vdb" voxelize leaf.obj -o x.txt
refuses ".jpg" trace leaf.obj --picture x.jpg
refuses "number" slab --omega ""
refuses "--json" --json slab
refuses "folder" trace folder.toml
{ printf '['; printf 'a.%.0s' {1..50000}; printf 'b]\n'; } >deep.toml
refuses "deep.toml:1" trace deep.toml
"$program" slab >/dev/full 2>/dev/null && fail "slab: lost output is no success"
printf '[tree]\nfile = "leaf.obj"\n[ground]\nalbedo = 0.2\n' >ground.toml
printf '[tree]\nfile = "leaf.obj"\n[stand]\nkind = "positions"\npositions = [[0, 0, 45]]\n' >rotated.toml
refuses "ground albedo" validate ground.toml
refuses "rotation" validate rotated.toml
refuses "rotation" render rotated.toml -o x.png
refuses "period" validate leaf.obj --period 0.01 0.01
refuses "--only-picture" trace leaf.obj --only-picture -o x.csv
refuses "/dev/null" voxelize leaf.obj -o /dev/null
refuses "albedo" trace leaf.obj --albedo 1.0000001

does "COMMAND" --help
does "zenith_deg" --help scene
does "Sunfleck" --version
for command in validate slab plant voxelize trace render; do does "--json" $command --help; done
does "reflectance" slab --omega 1 --thickness 5
does "1 leaf and 0 wood" plant flat.obj
does "cells" voxelize leaf.obj -o leaf.vdb --cell-size 0.1
does "cells" voxelize leaf.vdb
does '"absorbed_leaves"' trace leaf.obj --paths 1000 --json
does '"models"' --json leaf.obj --paths 1000 --no-pictures -o report
does "wrote" validate leaf.obj --paths 1000 --no-pictures -o report
[ -s report/report.html ] && [ -s report/report.json ] || fail "validate: no report"

head -c "$(($(stat -c %s leaf.vdb) / 2))" leaf.vdb >truncated.vdb
refuses "truncated.vdb" voxelize truncated.vdb
printf 'g,omega,thickness,mu0\n0,1,inf,1\n0.5,0.9,10,0.5\n' >cases.csv
does "g,omega,thickness,mu0,reflectance,transmittance,direct" slab --batch cases.csv
does "0,1,inf,1,1," slab --batch cases.csv

# Ctrl-C at any moment ends the program in an orderly way: done before it came (0), ended early (1), or not yet listening
# (130); never by a crash.
for delay in 0.1 0.3 0.6 1 2; do
  timeout --preserve-status -s INT $delay "$program" validate maple --no-pictures -o interrupted >/dev/null 2>stderr.txt
  status=$?
  case $status in 0 | 1 | 130) ;; *) fail "validate, interrupted after $delay s: status $status: $(head -c 400 stderr.txt)" ;; esac
done

[ $failures -eq 0 ] || { echo "$failures failures"; exit 1; }
echo "all as it should be"
