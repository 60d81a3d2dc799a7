# SPDX-License-Identifier: GPL-3.0-or-later
# --dry-run: the number of convolutions that it expects is within a factor of 2 of that of the run, for all effects.
# long/pipe_forecasts.sh compares the seconds.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/forecasts.sh"

forecast_maps 64
while IFS='|' read -r name _ command; do
    forecast_run 64 "$command"
    ratio=$(forecast_work)
    if [ "$ratio" = none ]; then
        claim "$name: no number of convolutions, but a time" says '[0-9] s( with|$)' cat plan.txt
    else
        between 0.5 "$ratio" 2 "$name: convolutions, expected over counted"
    fi
done < <(forecast_rows)

metal='--E1 1GPa --nu1 0.3 --E2 rigid'
forecast_maps 96
rc-solve --quiet $metal --mean-pressure 2MPa h96.rcg -o pressed.rcg
claim "a body that does not yield costs an elastic contact" says 'about [567] convolutions' \
    rc-solve --periodic $metal --mean-pressure 5MPa --yield 0.9GPa --dry-run h64.rcg

# ---- stresses ----

fatigue="rc-fatigue --bending-limit 60MPa --torsion-limit 37MPa --pass x --depths 1um:9um:3"
claim "stresses have a time" says 'about [0-9]+ MiB, [0-9.e-]+ s with' rc-stress --depths 0:9um:4 --dry-run pressed.rcg
claim "  it is unknown where the memory is too small" says 'MiB, unknown time' rc-stress --memory 1M --depths 0:9um:4 --dry-run pressed.rcg
claim "fatigue has a time" says 'about [0-9]+ MiB, [0-9.e-]+ s with' $fatigue --dry-run pressed.rcg
claim "  it is unknown where the memory is too small" says 'MiB, unknown time' $fatigue --memory 1M --dry-run pressed.rcg

# ---- flow and heat ----

claim "a leak has memory and a time" says 'about [0-9]+ MiB, [0-9.e-]+ s with' rc-leak --dry-run pressed.rcg
claim "  as heat does" says 'about 12 convolutions, [0-9]+ MiB, [0-9.e-]+ s with' \
    rc-heat --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 1.2e-5,1.2e-5 --dry-run pressed.rcg
rc-heat --quiet --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 1.2e-5,1.2e-5 --report heat.json -o hot.rcg pressed.rcg
between 6 "$(field convolutions heat.json)" 24 "  within a factor of 2 of the run"
