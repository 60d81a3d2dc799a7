# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by the tests of rc-scene, after pipe.sh: functions that run it and read its report.

# effect NAME FILE: prints the object of an effect in a report of one line.
effect() { perl -MJSON::PP -e '
    local $/; my $r = JSON::PP->new->decode(<STDIN>);
    for (@{$r->{scene}}) { print JSON::PP->new->canonical->encode($_) if $_->{effect} eq $ARGV[0] }' "$1" <"$2"; }
# of NAME FILE KEY...: prints a member of an effect.
of() { perl -MJSON::PP -e '
    local $/; my $r = JSON::PP->new->decode(<STDIN>); my $name = shift;
    my ($e) = grep { $_->{effect} eq $name } @{$r->{scene}}; $e = $e->{$_} for @ARGV;
    print defined $e ? $e : "null"' "$1" "${@:3}" <"$2"; }
scene() { rc-scene --quiet --report - "$@"; }
