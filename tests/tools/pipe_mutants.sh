# SPDX-License-Identifier: GPL-3.0-or-later
# Checkpoints with right checksums and false contents, and tables with false contents, are read or refused:
# no tool crashes, hangs, or refuses without a message. tests/fuzz/mutants.py makes the files: here 20 or 40,
# with RC_LONG 4000 of each kind.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/python.sh"
python=$(python_with zlib resource) || skip "Python with zlib and resource, which is not here"

mutants() { "$python" "$RC_SOURCE/tests/fuzz/mutants.py" --bin "$RC_BIN" "$@"; }
count=40
with_address_sanitizer && count=20
before_release && count=4000
mutants --count "$count" >ends.txt
for subject in $(mutants --list); do
    claim "mutants for $subject" grep "^$subject: .*: no finding$" ends.txt
done
cat ends.txt
