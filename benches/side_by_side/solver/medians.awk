# Medians by solver of: analysis, first and second factorisation, solve, peak memory; and ratios of frontal's to others'.
{
    count[$1]++
    for (field = 3; field <= 7; field++) value[$1, field, count[$1]] = $field
    error[$1] = $8
    unknowns = $2
}

function median(solver, field,    n, i, j, t, sorted) {
    n = count[solver]
    for (i = 1; i <= n; i++) sorted[i] = value[solver, field, i]
    for (i = 2; i <= n; i++)
        for (j = i; j > 1 && sorted[j] + 0 < sorted[j - 1] + 0; j--) {
            t = sorted[j]; sorted[j] = sorted[j - 1]; sorted[j - 1] = t
        }
    return sorted[int((n + 1) / 2)]
}

END {
    printf "%d unknowns; seconds of processor time, medians of %d runs\n", unknowns, count["frontal"]
    printf "%-16s %9s %9s %9s %9s %10s  %s\n", "", "analysis", "first", "again", "solve", "peak MB", "backward error"
    for (solver in count) {
        printf "%-16s %9.3f %9.3f %9.3f %9.4f %10.0f  %s\n", solver, median(solver, 3), median(solver, 4),
            median(solver, 5), median(solver, 6), median(solver, 7) / 1024, error[solver]
    }
    ratios("frontal")
    if ("frontal-ldlt" in count) ratios("frontal-ldlt")
}

# Those of one solver to all others.
function ratios(of,    solver, field) {
    for (solver in count) if (solver != of) {
        printf "%-25s", of "/" solver
        for (field = 3; field <= 7; field++) printf " %9.2f", median(of, field) / median(solver, field)
        print ""
    }
}
