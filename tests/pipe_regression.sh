# The sample surfaces keep their contact: area, peak pressure, approach, plastic area and largest Mises stress of the table, which
# other engines and methods computed.
. "$(dirname "$0")/pipe.sh"

grep -v '^#' "$RC_SOURCE/tests/regression.txt" >table.txt

# Field $2 of the JSON file $1 is $3 within the relative difference $4.
near() {
    perl -e '
        my ($file, $field, $want, $within) = @ARGV;
        open(my $in, "<", $file) or die; my $text = join "", <$in>;
        my ($got) = $text =~ /$field": \{?(?:"value": )?([-+0-9.e]+)/ or die "$field: not in $file\n";
        exit(0) if abs($got - $want) <= $within * abs($want);
        print STDERR "$field: $got, not $want\n"; exit(1);' "$@"
}

row() {
    local surface=$1 options=$2 area=$3 peak=$4 approach=$5 plastic=$6 mises=$7
    case $surface in
    rough-sphere*) cat ;;
    *) rc-detrend --fill --poly 2 ;;
    esac < <(rc-import "$RC_SOURCE/sample_surfaces/$surface") |
        rc-solve --quiet $options --tol 1e-8 --output pressure --report solve.json -o pressure.rcg &&
        rc-stress --quiet --nu 0.3 --depths 0.5um,2um,8um --components mises --report stress.json \
            -o mises.rcg pressure.rcg &&
        near solve.json contact_area "$area" 1e-4 && near solve.json max_pressure "$peak" 1e-6 &&
        near solve.json approach "$approach" 1e-6 && near solve.json plastic_area "$plastic" 1e-3 &&
        near stress.json mises "$mises" 1e-6
}

while IFS=$'\t' read -r surface options numbers; do
    claim "$surface $options" row "$surface" "$options" $numbers
done <table.txt

finish
