# SPDX-License-Identifier: GPL-3.0-or-later
# rc-import --list prints for each of many files its format, or the reason why it cannot be read. It fails at
# the end if there was a bad file.
. "$(dirname "$0")/../pipe.sh"

printf '# Channel: Topo\n# Width: 6 um\n# Height: 5 um\n# Value units: nm\n1 2 3\n4 5 6\n' >a.txt
sed 's/Topo/Other/' a.txt >c.txt
printf 'neither here nor there\n' >b.txt
refuses 1 '^rc-import: b.txt: not recognised' "a bad file among good ones is named in a message" \
    'rc-import --list a.txt b.txt c.txt >list.txt'
claim "--list continues before and after a bad file" test "$(grep -o '^[ac].txt: ascii\|Topo$\|Other$' list.txt | tr '\n' ' ')" = \
    "a.txt: ascii Topo c.txt: ascii Other "
refuses 1 '^rc-import: nowhere.txt: No such file' "so is one that is not there" \
    'rc-import --list nowhere.txt a.txt >list.txt'
claim "the file after a bad one is listed" grep -q Topo list.txt
refuses 1 '^rc-import: [.]: reading failed \(Is a directory\)' "so is a folder" 'rc-import --list . a.txt'
refuses 1 '^rc-import: b.txt: not recognised' "--quiet hides no failure" 'rc-import --quiet --list b.txt a.txt'
refuses 1 '^rc-import: b.txt: ' "with -o" 'rc-import --list -o listed.txt b.txt a.txt'
claim "the list is complete" grep -q Topo listed.txt
claim "without a bad file the status is 0" rc-import --list a.txt c.txt
rc-import --list a.txt b.txt c.txt >both.txt 2>&1
claim "on a terminal lists and messages appear in the order of the files" \
    test "$(grep -oE '^a.txt|b.txt|^c.txt' both.txt | tr '\n' ' ')" = "a.txt b.txt c.txt "
refuses 1 'b.txt: not recognised' "without --list the first bad file ends it" 'rc-import a.txt b.txt c.txt'

# ---- several images, and units on separate lines ----

printf '# Channel: %s\n# Width: 4 um\n# Height: 3 um\n# Value units: %s\n1 2 3 4\n5 6 7 8\n9 10 11 12\n' \
    Phase deg Height nm >two.txt
claim "of two images in one text the height is taken" says '^[*] +2 +4 +3 +1e-06 +1e-06 m ' rc-import --list two.txt
claim "the other image is a channel too" says '^  +1 +4 +3 +1e-06 +1e-06 deg +1 +12 Phase$' rc-import --list two.txt
claim "--channel selects it" says '^unit=deg$' rc-import --channel phase two.txt
printf '# Daisy frame view snapshot\n# x-pixels: 4\n# y-pixels: 3\n# x-length: 8\n# y-length: 6\n# x-unit: um\n' >daisy.asc
printf '# y-unit: um\n# z-unit: nm\n# Start of Data:\n1 2 3 4\n5 6 7 8\n9 10 11 12\n' >>daisy.asc
claim "lengths have the unit that another line gives" says ' 4 +3 +2e-06 +2e-06 m ' rc-import --list daisy.asc
