# SPDX-License-Identifier: GPL-3.0-or-later
# rc-scene: verdicts on contacts from practice agree with what publications say about such contacts, or the file of the
# contacts explains the difference. With each commit every 12th contact, before a release all of them.
. "$(dirname "$0")/../pipe.sh"

export RC_THREADS=1
every=12
! before_release || every=1
claim "rc-scene judges every $every. contact of the handbook" perl "$RC_SOURCE/tests/scene/handbook.pl" "$RC_SOURCE/tests/scene/handbook.txt" "$every"
cp claim.out verdicts.txt
grep -v '^agrees' verdicts.txt
claim "  no verdict differs without an explanation" bash -c '! grep "^disagrees" verdicts.txt'
claim "  at most one in seven is undecided" awk '/^(agrees|explained|undecided)/ { n++; u += /^undecided/ } END { exit !(n > 0 && u * 7 <= n) }' verdicts.txt
