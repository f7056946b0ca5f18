#!/usr/bin/env bash
# Runs the viewer by scripts, without a window and in one: pictures must be equal where nothing may differ, changes must
# compute what they need and nothing else, and what is wrong must end in one line. Usage: view.sh PATH_TO_SUNFLECK WINDOW
#   WINDOW  "offscreen", or "window" to open one on the display of xvfb-run; 77 where there is no such program
set -u
program=$(readlink -f "$1")
way=$2
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place" || exit 1
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }

if [ "$way" = window ]; then
  command -v xvfb-run >/dev/null || { echo "no xvfb-run: install xvfb"; exit 77; }
  view() { xvfb-run -a -s "-screen 0 1280x1024x24" "$program" view "$@"; }
else
  view() { "$program" view --offscreen "$@"; }
fi
# runs SCRIPT_FILE OPTIONS...: must end well and say nothing on stderr
runs() {
  local script=$1; shift
  view "$@" --script "$script" >stdout.txt 2>stderr.txt </dev/null
  local status=$?
  [ $status -eq 0 ] || fail "$script: status $status: $(head -c 600 stderr.txt)"
  [ ! -s stderr.txt ] || fail "$script: wrote to stderr: $(head -c 600 stderr.txt)"
}
# refuses STATUS WHAT_THE_MESSAGE_MUST_HOLD SCRIPT_TEXT
refuses() {
  printf '%b' "$3" >wrong.txt
  view trees.toml --script wrong.txt >stdout.txt 2>stderr.txt </dev/null
  local status=$?
  [ $status -eq "$1" ] || fail "'$3': status $status, not $1: $(head -c 400 stderr.txt)"
  [ "$(wc -l <stderr.txt)" -eq 1 ] || fail "'$3': not one line on stderr: $(head -c 600 stderr.txt)"
  grep -qF -- "$2" stderr.txt || fail "'$3': \"$2\" is not in: $(cat stderr.txt)"
}

# A small tree: 60 leaves and a trunk, two of them and a ground.
awk 'BEGIN { srand(3)
  for (i = 0; i < 60; i++) { x = 2 * rand() - 1; y = 2 * rand() - 1; z = 1 + 2 * rand(); s = 0.15
    printf "v %g %g %g\nv %g %g %g\nv %g %g %g\nv %g %g %g\n", x-s, y, z-s*rand(), x, y-s, z, x+s, y, z+s*rand(), x, y+s, z }
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

cat >changes.txt <<'END'
panels off
samples 4
resize 200 160
wait ready
expect recomputed light_maps        # all was made once
screenshot start.png
screenshot again.png
expect same start.png again.png
camera orbit 70 20
wait ready
expect recomputed none              # the camera makes nothing anew
screenshot turned.png
camera save side
camera orbit 20 10
camera load side
wait ready
screenshot loaded.png
expect same turned.png loaded.png
sun 50 120
wait ready
expect recomputed light_maps
screenshot sun.png
undo
wait ready
screenshot undone.png
expect same turned.png undone.png
redo
wait ready
screenshot redone.png
expect same sun.png redone.png
undo 9                              # more than there is
wait ready
leaf albedo 0.3
wait ready
expect trees 3
model ss
wait ready
model sppg
select 2
move 0.5 0.25
wait ready
expect recomputed none              # it is on its way: only the next line asks for it
END
sed -i '$d' changes.txt
cat >>changes.txt <<'END'
expect recomputed light_maps 0      # of a moved tree no map is made
copy 0 3
expect trees 4
expect selected 4
delete
expect trees 3
add 6 6
paint 12 12 3 2
redo
undo 2
expect trees 3
wait ready
resize 1 1
wait ready
resize 1500 1100
wait ready
resize 200 160
minimise
frames 3
restore
wait ready
sun 120 0                           # night
wait ready
sun 30 0
sky uniform 0.3
wait ready
sky none
ground 0
compare with ss
compare wipe 0.5
wait ready
screenshot wipe.png
compare flip
compare difference
wait ready
screenshot difference.png
exr layers.exr
compare off
END
runs changes.txt trees.toml
for file in start turned sun wipe difference; do [ -s $file.png ] || fail "no $file.png"; done
cmp -s start.png turned.png && fail "turning the camera changes nothing"
cmp -s turned.png sun.png && fail "turning the sun changes nothing"
[ -s layers.exr ] || fail "no layers.exr"

# A tree is picked and dragged on the ground by the mouse, in one step of undo.
cat >drag.txt <<'END'
panels off
samples 1
resize 300 300
camera orbit 0 60
camera whole
select none
wait ready
screenshot before.png
pick 10 10
expect selected 0
END
runs drag.txt trees.toml

# The scene that is saved is the one that was shown.
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
cat >open.txt <<'END'
panels off
samples 2
resize 160 120
wait ready
screenshot opened.png
END
runs save.txt trees.toml
runs open.txt saved.toml
cmp -s shown.png opened.png || fail "the saved scene looks different"

# Monte Carlo beside a model, the same on every run.
cat >reference.txt <<'END'
panels off
samples 4
resize 80 60
compare with reference
compare flip
wait reference 0.3
screenshot FILE
compare difference
wait reference 0.3
screenshot difference_FILE
END
for file in one.png two.png; do sed "s/FILE/$file/" reference.txt >of.txt; runs of.txt trees.toml; done
cmp -s one.png two.png || fail "Monte Carlo differs from run to run"

view trees.toml --frames 3 >stdout.txt 2>stderr.txt || fail "--frames 3: $(cat stderr.txt)"

refuses 2 'wrong.txt:2: sun ZENITH = "200": must be in [0, 180]' 'undo\nsun 200 0\n'
refuses 2 'wrong.txt:1: tree = 9: must be' 'select 9\n'
refuses 2 'wrong.txt:1: model = "none": must be one of ss' 'model none\n'
refuses 2 'wrong.txt:1: x.gif' 'screenshot x.gif\n'
refuses 2 'wrong.txt:1: no tree is selected' 'move 1 1\n'
refuses 2 'wrong.txt:2: camera "x"' '\ncamera load x\n'
refuses 1 'wrong.txt:1: expected 7 trees, but there are 3' 'expect trees 7\n'
refuses 2 'wrong.txt:1: wait reference' 'wait reference 0.1\n'
refuses 2 'wrong.txt' 'directions 3\n'
view missing.toml --frames 1 >stdout.txt 2>stderr.txt
[ $? -eq 2 ] || fail "a missing scene: $(cat stderr.txt)"

if [ "$way" = window ]; then
  env -u DISPLAY -u WAYLAND_DISPLAY "$program" view trees.toml --frames 1 >stdout.txt 2>stderr.txt
  [ $? -eq 1 ] || fail "no display is no failure"
  grep -q "needs a display" stderr.txt || fail "no display: $(cat stderr.txt)"
  MESA_GL_VERSION_OVERRIDE=3.3 view trees.toml --frames 1 >stdout.txt 2>stderr.txt
  [ $? -eq 1 ] || fail "an old OpenGL is no failure"
  grep -q "needs OpenGL 4.5" stderr.txt || fail "an old OpenGL: $(cat stderr.txt)"
fi
[ $failures -eq 0 ] && echo "all well"
exit $((failures > 0))
