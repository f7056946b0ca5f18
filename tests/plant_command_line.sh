#!/usr/bin/env bash
# Runs `sunfleck plant` as a user would: what is right must work, and what is wrong must end with status 2 and one line
# on stderr, and leave nothing behind. Usage: plant_command_line.sh PATH_TO_SUNFLECK
source "$(dirname "$0")/as_a_user.bash" "$1"

refuses "species" plant --species baobab
does "wrote my.toml" plant --write-species cherry my.toml
does "leaf angles" plant my.toml -o my.glb --thumbnail my.png
does "8720 (17440 triangles)" plant my.glb
does "weeping_willow" plant --list
does "wrote stand.toml" plant leaf.obj --stand poisson --spacing 4 --area 20 20 -o stand.toml
printf 'x,y,rotation_deg,species\n0,0,0,my.toml\n9,0,45,my.toml\n' >positions.csv
does "2 trees of 1 kinds" plant --stand positions.csv -o stand.toml
does "absorbed by leaves" trace stand.toml --paths 1000
does "2 trees" plant --stand positions.csv -o stand.glb
does "wrote e.vdb: 9.4" plant turbid_ellipsoid --density 1.5 -o e.vdb
does "90 (180 triangles)" plant random_crown --leaves 90 -o crown.ply
printf '0.1 0 0 1 0 0 1\n0.1 1 1 2 0 1 1\n' >leaves.txt
does "2 (20 triangles)" plant leaves.txt
does "wrote leaves.vdb" voxelize leaves.txt -o leaves.vdb
does "wrote forest.toml" plant stand.glb -o forest.toml
does "absorbed by leaves" trace forest.toml --paths 1000
does '"trees": 2' plant stand.glb --json
refuses 'leaf "palm": must match a material, group or object' plant leaf.obj --leaf palm
refuses '--unit = "furlong": must be one of m, dm' plant leaf.obj --unit furlong
refuses '--up = "w": must be one of x, y, z' plant leaf.obj --up w
refuses "must be of a glTF file" plant leaf.obj --mesh oak
refuses "is a stand of instances" plant stand.glb --stand regular -o other.toml
refuses "--cards" plant --cards cut
refuses "gallery.jpg" plant --gallery gallery.jpg
sed 's/^scale = .*/scale = -1.0/' my.toml >bad.toml
refuses "bad.toml:13: tree.scale = -1: must be a number in" plant bad.toml -o bad.obj
[ -e bad.obj ] && fail "plant: wrote a tree of wrong parameters"
printf 'x,y\n0,nan\n' >positions.csv
refuses "positions.csv:2" plant --stand positions.csv -o stand.toml
refuses ".toml" plant --stand regular -o stand.obj
refuses ".vdb" plant turbid_ellipsoid -o e.obj
refuses "--stand" plant --spacing 3
refuses "one of the extensions" plant -o tree.txt
refuses "--species" plant leaf.obj --species maple

# What would be ignored is refused.
for option in "--unit cm" "--leaf x" "--up y"; do refuses "${option%% *}: must be for a mesh file, not for cherry" plant cherry $option; done
refuses "--leaves: must be for random_crown" plant cherry --leaves 9
refuses "--density: must be for turbid_ellipsoid" plant cherry --density 1
refuses "must not be empty" plant cherry --stand ""
refuses "input: must be without --list" plant --list foo
refuses "stand.toml: is a scene file" plant stand.toml -o x.obj
conclude
