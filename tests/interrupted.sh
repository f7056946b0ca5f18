#!/usr/bin/env bash
# Ctrl-C at any moment ends the program in an orderly way: done before it came (0), ended early (1), or not yet listening
# (130); never by a crash. Usage: interrupted.sh PATH_TO_SUNFLECK
source "$(dirname "$0")/as_a_user.bash" "$1"

for delay in 0.1 0.3 0.6 1 2; do
  timeout --preserve-status -s INT $delay "$program" validate maple --no-pictures -o interrupted >/dev/null 2>stderr.txt
  status=$?
  case $status in 0 | 1 | 130) ;; *) fail "validate, interrupted after $delay s: status $status: $(head -c 400 stderr.txt)" ;; esac
done
for delay in 0.5 1 2; do
  rm -f cut.png
  timeout --preserve-status -s INT $delay "$program" render cherry16 --model field --size 64 48 -o cut.png >/dev/null 2>stderr.txt
  status=$?
  case $status in
    0) [ -s cut.png ] || fail "render of the field: no picture" ;;
    1 | 130) [ -z "$(ls -A | grep 'cut.*png')" ] || fail "render of the field, interrupted after $delay s: left something behind" ;;
    *) fail "render of the field, interrupted after $delay s: status $status: $(head -c 400 stderr.txt)" ;;
  esac
done
printf 'P2 900 900 255\n' >map.pgm && seq 810000 | awk '{ print 20 + $1 % 91 }' >>map.pgm
for delay in 0.5 1; do
  rm -f leaf_upper.png leaf.toml
  timeout --preserve-status -s INT $delay "$program" leaf --fit-maps --upper-reflectance map.pgm --transmittance map.pgm \
    -o leaf.png >/dev/null 2>stderr.txt
  status=$?
  case $status in
    0) [ -s leaf.toml ] || fail "leaf --fit-maps: no scene" ;;
    1 | 130) [ -z "$(ls -A | grep 'leaf.*[gl]$')" ] || fail "leaf --fit-maps, interrupted after $delay s: left something behind" ;;
    *) fail "leaf --fit-maps, interrupted after $delay s: status $status: $(head -c 400 stderr.txt)" ;;
  esac
done

conclude
