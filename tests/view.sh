#!/usr/bin/env bash
# Runs the viewer by scripts, without a window or in one: pictures must be equal where nothing may differ, changes must
# compute what they need and nothing else, and what is wrong must end in one line. Usage: view.sh PATH_TO_SUNFLECK WAY
#   WAY  "offscreen", or "window" to open one on a display of Xvfb; status 77 where there is no such program
tests=$(readlink -f "$(dirname "$0")")
source "$tests/as_a_user.bash" "$1"
way=$2

if [ "$way" = window ]; then
  command -v Xvfb >/dev/null || { echo "skipped: there is no Xvfb (package xvfb)"; exit 77; }
  mkfifo display
  Xvfb -displayfd 3 -screen 0 1280x1024x24 -nolisten tcp 3>display >/dev/null 2>&1 &
  trap 'kill '$!'; rm -rf "$place" "$place.before"' EXIT
  read -r number <display && rm display
  export WAYLAND_DISPLAY= DISPLAY=:$number
  view() { "$program" view "$@"; }
else
  view() { "$program" view --offscreen "$@"; }
fi
# runs SCRIPT_FILE SCENE: must end well and say nothing on stderr
runs() {
  view "$2" --script "$1" >stdout.txt 2>stderr.txt </dev/null
  local status=$?
  [ $status -eq 0 ] || fail "$1: status $status: $(head -c 600 stderr.txt)"
  [ ! -s stderr.txt ] || fail "$1: wrote to stderr: $(head -c 600 stderr.txt)"
}
# stops STATUS WHAT_THE_MESSAGE_MUST_HOLD SCRIPT_TEXT
stops() {
  printf '%b' "$3" >wrong.txt
  view trees.toml --script wrong.txt >stdout.txt 2>stderr.txt </dev/null
  local status=$?
  [ $status -eq "$1" ] || fail "'$3': status $status, not $1: $(head -c 400 stderr.txt)"
  [ "$(wc -l <stderr.txt)" -eq 1 ] || fail "'$3': not one line on stderr: $(head -c 600 stderr.txt)"
  grep -qF -- "$2" stderr.txt || fail "'$3': \"$2\" is not in: $(cat stderr.txt)"
}

# Three small trees of 60 leaves and a trunk.
awk 'BEGIN { srand(3)
  for (i = 0; i < 60; i++) { x = 2 * rand() - 1; y = 2 * rand() - 1; z = 1 + 2 * rand(); s = 0.15; t = s * (2 * rand() - 1)
    printf "v %g %g %g\nv %g %g %g\nv %g %g %g\nv %g %g %g\n", x-s, y-s, z-t, x+s, y-s, z-t, x+s, y+s, z+t, x-s, y+s, z+t }
  print "v -0.1 0 0\nv 0.1 0 0\nv 0 0 2\nusemtl leaf"
  for (i = 0; i < 60; i++) print "f", 4*i+1, 4*i+2, 4*i+3, 4*i+4
  print "usemtl bark\nf 241 242 243" }' >small.obj
cat >trees.toml <<'END'
[tree]
file = "small.obj"
[stand]
kind = "positions"
positions = [[0, 0], [4, 0], [0, 5]]
[ground]
albedo = 0.16
[sun]
zenith_deg = 30
END

# The sun turned, a tree dragged, undone; 1 x 1 and large, minimised, compared.
cat >changes.txt <<'END'
panels off
samples 4
resize 200 160
wait ready
expect recomputed light_maps        # all was made once
screenshot start.png
camera save first
camera orbit 70 20
wait ready
expect recomputed none              # the camera makes nothing anew
screenshot turned.png
camera save side
camera load first
wait ready
screenshot again.png
expect same start.png again.png
camera load side
sun 50 120
wait ready
expect recomputed light_maps 1
screenshot sun.png
undo
wait ready
screenshot undone.png
expect same turned.png undone.png
redo
wait ready
screenshot redone.png
expect same sun.png redone.png
expect recomputed light_maps 2      # there and back
leaf albedo 0.3
model ss
wait ready
expect recomputed light_maps 0      # the former ones serve
undo 2
select 2
move 0.5 0.25
wait ready
expect recomputed depths            # of the trees around it
copy 0 3
wait ready
expect recomputed light_maps 0      # all trees share the kind's
expect trees 4
expect selected 4
delete
add 6 6
paint 12 12 3 2
undo 3
expect trees 4
undo
expect trees 3
wait ready
resize 1 1
wait ready
resize 1100 800
wait ready
minimise
frames 3
restore
resize 200 160
wait ready
sun 120 0                           # night
wait ready
screenshot night.png
sun 30 0
sky uniform 0.3
wait ready
sky none
ground 0
layer thickness
wait ready
layer total
compare with ss
compare wipe 0.5
wait ready
screenshot wipe.png
compare flip
wait ready
compare difference
wait ready
screenshot difference.png
exr layers.exr
compare off
END
runs changes.txt trees.toml
for file in start turned sun night wipe difference; do [ -s $file.png ] || fail "no $file.png"; done
for pair in "start turned" "turned sun" "sun night" "wipe difference"; do
  set -- $pair
  cmp -s "$1.png" "$2.png" && fail "$1.png and $2.png are the same"
done
[ -s layers.exr ] || fail "no layers.exr"

# The light field: at once on cells, then along lines, which is what stays; of another colour of the sun, which takes no
# solution, there is no preview.
cat >field.txt <<'END'
panels off
samples 1
resize 200 160
model field
wait preview
screenshot preview.png
wait ready
screenshot field.png
expect recomputed preview:_cells 1
sun 30 0 0.5
wait preview
screenshot dim_field.png
wait ready
screenshot dim_ready.png
expect same dim_field.png dim_ready.png
expect recomputed preview:_solutions 0
sun 50 20
wait preview
sun 30 0 1
wait ready
screenshot again.png
expect same field.png again.png
END
runs field.txt trees.toml
cmp -s preview.png field.png && fail "the field's preview is the field"
"$program" render trees.toml --model field --preview -o preview.exr >stdout.txt 2>stderr.txt || fail "render --preview: $(cat stderr.txt)"
grep -q "on cells" stdout.txt || fail "render --preview: $(cat stdout.txt)"

# From straight above, 0.02 m to a pixel: the first tree's leaves fill the middle of the picture. A click selects it, a drag
# moves it by 50 pixels, which is one step.
cat >above.toml <<'END'
[tree]
file = "small.obj"
[stand]
kind = "positions"
positions = [[0, 0], [40, 0]]
[camera]
target = [0, 0, 0]
elevation_deg = 90
half_width = 3
width = 300
height = 300
END
cat >mouse.txt <<'END'
panels off
samples 1
resize 300 300
wait ready
pick 3 3
expect selected 0
screenshot before.png
drag CLICK CLICK
wait ready
expect selected 1
drag CLICK TO
wait ready
screenshot moved.png
undo
wait ready
screenshot undone.png
expect same before.png undone.png
press escape
press tab
wait ready
expect selected 0
END
# Where a leaf is seen: told by the probe.
{ echo "panels off"; echo "resize 300 300"; for x in $(seq 110 8 190); do echo "probe $x 150"; done; } >look.txt
runs look.txt above.toml
at=$(awk '/leaf/ { print $1, 150; exit }' stdout.txt)
if [ -n "$at" ]; then
  sed -i "s/CLICK CLICK/$at $at/; s/CLICK TO/$at $((${at% *} + 50)) 150/" mouse.txt
  runs mouse.txt above.toml
  cmp -s before.png moved.png && fail "a dragged tree stays where it was"
else
  fail "no leaf is seen from above: $(cat stdout.txt)"
fi

# The scene that is saved is the one that was shown, and what other commands read.
cat >save.txt <<'END'
panels off
samples 2
resize 160 120
sun 40 30
select 1
move -1 2
wait ready
screenshot shown.png
save saved.toml
END
printf 'panels off\nsamples 2\nresize 160 120\nwait ready\nscreenshot opened.png\n' >open.txt
runs save.txt trees.toml
runs open.txt saved.toml
cmp -s shown.png opened.png || fail "the saved scene looks different"
"$program" render saved.toml -o rendered.png >/dev/null 2>stderr.txt || fail "render of the saved scene: $(cat stderr.txt)"

# Leaves told by what they are: other pictures each, undone, and a saved scene that tells them so.
cat >leaves.txt <<'END'
panels off
samples 2
resize 80 60
wait ready
screenshot numbers.png
leaf species beech
wait ready
screenshot species.png
leaf prospect chlorophyll 10
wait ready
screenshot changed.png
save changed.toml
leaf slab all 0.5 10 0.2
leaf slab blue 5 10 0.2
wait ready
screenshot slab.png
save slab.toml
undo 3
wait ready
screenshot undone.png
expect same species.png undone.png
undo
wait ready
screenshot undone.png
expect same numbers.png undone.png
END
runs leaves.txt trees.toml
for pair in "numbers species" "species changed" "changed slab"; do
  set -- $pair
  cmp -s "$1.png" "$2.png" && fail "$1.png and $2.png are the same"
done
grep -qxF 'leaf_species = "beech"' changed.toml && grep -qxF 'leaf_prospect = { chlorophyll = 10 }' changed.toml ||
  fail "changed.toml: $(grep leaf_ changed.toml)"
grep -qxF 'leaf_slab = { absorption = [0.5, 0.5, 5], scattering = 10, thickness = 0.2 }' slab.toml ||
  fail "slab.toml: $(grep leaf_ slab.toml)"
for file in changed slab; do
  printf 'panels off\nsamples 2\nresize 80 60\nwait ready\nscreenshot opened.png\n' >open.txt
  runs open.txt $file.toml
  cmp -s $file.png opened.png || fail "the saved scene $file.toml looks different"
done

# Images of leaves and a lower side: other pictures each by the mean of the maps, made in the background, and nothing else
# made anew; undone; wrong files change nothing. The scene that is saved shows the same.
awk 'BEGIN { print "P3 6 4 255"; for (i = 0; i < 24; i++) { v = 10 * i; print v, 255 - v, v } }' >upper.ppm
awk 'BEGIN { print "P3 6 4 255"; for (i = 0; i < 24; i++) print 200, 200, 200 }' >gloss.ppm
awk 'BEGIN { print "P3 5 4 255"; for (i = 0; i < 20; i++) print 200, 200, 200 }' >narrow.ppm
cat >maps.txt <<'END'
panels off
samples 2
resize 80 60
leaf slab all 0.5 10 0.2
wait ready
screenshot even.png
expect recomputed leaf_maps 0
leaf maps upper upper.ppm
wait ready
screenshot upper.png
expect recomputed leaf_maps 1
leaf maps upper_gloss gloss.ppm
wait ready
screenshot shiny.png
expect recomputed leaf_maps 1
leaf maps albedo 0.5 0.8 1
leaf slab all 0.5 10 0.4
wait ready
screenshot thick.png
expect recomputed light_maps 0
leaf lower reflectance 0.1 0.3 0.2
leaf lower gloss 0
leaf lower roughness 0.5
leaf maps relief 0.05
wait ready
screenshot lower.png
expect recomputed cells 0
sun 40 20
wait ready
expect recomputed leaf_maps 0
undo
wait ready
screenshot again.png
expect same lower.png again.png
save maps.toml
undo 4
wait ready
screenshot again.png
expect same thick.png again.png
undo 2
wait ready
screenshot again.png
expect same shiny.png again.png
leaf maps lower upper.ppm
leaf maps off upper_gloss
leaf lower same
wait ready
screenshot again.png
expect same upper.png again.png
leaf maps off all
wait ready
screenshot again.png
expect same even.png again.png
END
runs maps.txt trees.toml
for pair in "even upper" "upper shiny" "shiny thick" "thick lower"; do
  set -- $pair
  cmp -s "$1.png" "$2.png" && fail "$1.png and $2.png are the same"
done
grep -q '^leaf_maps = .*upper.ppm' maps.toml && grep -q '^leaf_lower = ' maps.toml || fail "maps.toml: $(grep leaf_ maps.toml)"
printf 'panels off\nsamples 2\nresize 80 60\nwait ready\nscreenshot opened.png\n' >open.txt
runs open.txt maps.toml
cmp -s lower.png opened.png || fail "the saved scene maps.toml looks different"

# The script that the documentation shows.
awk '/^    # turn the sun/ { shows = 1 } shows && !/^    / { exit } shows' \
  "$tests/../docs/VIEWER.md" | sed 's/^    //; s/^samples 16/panels off\nresize 90 60\nsamples 2/; s/0\.05 /0.5 /' >shown.txt
grep -q '^save scene.toml' shown.txt || fail "docs/VIEWER.md: no script is found"
runs shown.txt trees.toml

# A tree turned, an image as the sky, a camera saved, the exact model; then no tree at all, also by
# night. The scene that is saved holds all of it.
"$program" render trees.toml --size 32 16 -o sky.exr >/dev/null 2>stderr.txt || fail "a sky: $(cat stderr.txt)"
cat >none.txt <<'END'
panels off
samples 2
resize 80 60
camera save "from here"
camera orbit 70 20
select 1
turn 90
sky image sky.exr 30
model pp
wait ready
expect recomputed light_maps 2      # of the trees that are not turned, of the one that is
screenshot exact.png
exr exact.exr
select 1
delete
select 2
delete
select 1
delete
expect trees 0
wait ready
screenshot none.png
save none.toml
sky none
sun 120 0
wait ready
screenshot none_night.png
undo 3
expect trees 1
undo 2
expect trees 3
wait ready
END
runs none.txt trees.toml
printf 'panels off\nsamples 2\nresize 80 60\nmodel pp\nwait ready\nscreenshot none_opened.png\ncamera load "from here"\n' >open.txt
runs open.txt none.toml
cmp -s none.png none_opened.png || fail "the saved scene without trees looks different"
"$program" render none.toml --saved-camera "from here" -o none_rendered.png >/dev/null 2>stderr.txt ||
  fail "render of a scene without trees: $(cat stderr.txt)"
for file in exact.exr exact.png none_night.png; do [ -s $file ] || fail "no $file"; done

# Monte Carlo beside a model, the same on every run.
for run in one two; do
  printf '%s\n' "panels off" "samples 2" "resize 60 40" "wait ready" "compare with reference" "compare flip" \
    "wait reference 0.5" "screenshot $run.png" >reference.txt
  runs reference.txt trees.toml
done
cmp -s one.png two.png || fail "Monte Carlo differs from run to run"

view trees.toml --frames 3 >stdout.txt 2>stderr.txt || fail "--frames 3: $(cat stderr.txt)"
stops 2 'wrong.txt:2: sun ZENITH = "200": must be in [0, 180]' 'undo\nsun 200 0\n'
stops 2 'wrong.txt:1: no.hdr' 'sky image no.hdr\n'
stops 2 'wrong.txt:2: no.obj' '\nkind no.obj\n\n'
stops 2 'wrong.txt:1: tree = 9: must be' 'select 9\n'
stops 2 'wrong.txt:1: model = "none": must be one of ss' 'model none\n'
stops 2 'wrong.txt:1: x.gif' 'screenshot x.gif\n'
stops 2 'wrong.txt:1: leaf species = "oak": must be one of' 'leaf species oak\n'
stops 2 'wrong.txt:1: leaf prospect: sugar: must be one of' 'leaf prospect sugar 1\n'
stops 2 'wrong.txt:1: no.png' 'leaf maps upper no.png\n'
stops 2 'wrong.txt:1: trees.toml' 'leaf maps upper trees.toml\n'
stops 2 'wrong.txt:2: leaf: upper.ppm has 6 x 4 pixels' 'leaf maps upper upper.ppm\nleaf maps lower_gloss narrow.ppm\n'
stops 2 'wrong.txt:1: no tree is selected' 'move 1 1\n'
stops 2 'wrong.txt:2: camera "x"' '\ncamera load x\n'
stops 2 'wrong.txt:1: directions' 'directions 3\n'
stops 2 'wrong.txt:1: wait reference' 'wait reference 0.1\n'
stops 2 'wrong.txt:1: wait preview' 'wait preview\n'
stops 1 'wrong.txt:1: expected 7 trees, but there are 3' 'expect trees 7\n'
stops 1 'Monte Carlo needs a tree' \
  'panels off\nresize 60 40\nselect 1\ndelete\nselect 1\ndelete\nselect 1\ndelete\ncompare with reference\ncompare flip\nwait reference 0.5\n'
stops 1 'but recomputed' 'expect recomputed none\n'
view missing.toml --frames 1 >stdout.txt 2>stderr.txt
[ $? -eq 2 ] || fail "a missing scene: $(cat stderr.txt)"

if [ "$way" = window ]; then
  # The same pictures without a window.
  mkdir unseen && cp small.obj trees.toml changes.txt unseen
  (cd unseen && "$program" view trees.toml --offscreen --script changes.txt) 2>stderr.txt || fail "$(cat stderr.txt)"
  for file in start turned sun night wipe difference; do
    cmp -s $file.png unseen/$file.png || fail "$file.png differs without a window"
  done
  # One line when the display goes away.
  Xvfb -displayfd 3 -screen 0 640x480x24 3>display.txt >/dev/null 2>&1 &
  server=$!
  for _ in $(seq 100); do [ -s display.txt ] && break; sleep 0.1; done
  DISPLAY=:$(cat display.txt) "$program" view trees.toml >stdout.txt 2>stderr.txt </dev/null &
  viewer=$!
  for _ in $(seq 100); do grep -q libX11 /proc/$viewer/maps && break; sleep 0.1; done
  sleep 1
  kill $server
  wait $viewer
  [ $? -eq 1 ] || fail "a lost display is no failure"
  [ "$(cat stderr.txt)" = "sunfleck: failed: the display is lost: its server has ended or has closed the connection" ] ||
    fail "a lost display: $(cat stderr.txt)"
  env -u DISPLAY "$program" view trees.toml --frames 1 >stdout.txt 2>stderr.txt
  [ $? -eq 1 ] || fail "no display is no failure"
  grep -q "needs a display" stderr.txt || fail "no display: $(cat stderr.txt)"
  MESA_GL_VERSION_OVERRIDE=3.3 view trees.toml --frames 1 >stdout.txt 2>stderr.txt
  [ $? -eq 1 ] || fail "an old OpenGL is no failure"
  grep -q "needs OpenGL 4.5" stderr.txt || fail "an old OpenGL: $(cat stderr.txt)"
fi
conclude
