# SPDX-License-Identifier: GPL-3.0-or-later
# The contacts of the sample surfaces do not change. Area, peak pressure, approach, plastic area and largest
# Mises stress equal those of the table, which other engines and methods computed.
. "$(dirname "$0")/../pipe.sh"

grep -v '^#' "$RC_SOURCE/tests/tools/regression.txt" >table.txt

# keeps FILE FIELD VALUE WITHIN: the field of the JSON file equals the value within this relative difference.
keeps() {
    perl -e '
        my ($file, $field, $want, $within) = @ARGV;
        open(my $in, "<", $file) or die; my $text = join "", <$in>;
        my ($got) = $text =~ /$field": \{?(?:"value": )?([-+0-9.e]+)/ or die "$field: not in $file\n";
        exit(0) if abs($got - $want) <= $within * abs($want);
        print STDERR "$field: $got, not $want\n"; exit(1);' "$@"
}

# The pressure has a mean relative error of 1e-8; a single value, and figures from single values, may have a
# hundred times that. Areas are whole nodes: one of 10,000 nodes in contact may change its state, and one of
# 1000 at the hardness.
beside=1e-6
of_contact=1e-4
of_plastic=1e-3

row() {
    local surface=$1 options=$2 area=$3 peak=$4 approach=$5 plastic=$6 mises=$7
    case $surface in
    rough-sphere*) cat ;;
    *) rc-detrend --fill --poly 2 ;;
    esac < <(rc-import "$RC_SOURCE/sample_surfaces/$surface") |
        rc-solve --quiet $options --tol 1e-8 --output pressure --report solve.json -o pressure.rcg &&
        rc-stress --quiet --nu 0.3 --depths 0.5um,2um,8um --components mises --report stress.json \
            -o mises.rcg pressure.rcg &&
        [ "$(channels mises.rcg)" = "mises mises mises" ] &&
        keeps solve.json contact_area "$area" "$of_contact" && keeps solve.json max_pressure "$peak" "$beside" &&
        keeps solve.json approach "$approach" "$beside" && keeps solve.json plastic_area "$plastic" "$of_plastic" &&
        keeps stress.json mises "$mises" "$beside"
}

while IFS=$'\t' read -r surface options numbers; do
    claim "$surface $options" row "$surface" "$options" $numbers
done <table.txt
