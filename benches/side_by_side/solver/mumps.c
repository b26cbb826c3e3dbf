/* Times MUMPS on a Matrix Market file: analysis, two factorisations, ten solves.
 * One line: solver unknowns analysis first second solve peak_kB backward_error, in seconds of processor time. */
#include <dmumps_c.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

static double cpu(void) {
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_utime.tv_sec + usage.ru_stime.tv_sec
         + 1e-6 * (usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

static void fail(const char *message, int code) {
    fprintf(stderr, "%s (%d)\n", message, code);
    exit(1);
}

/* Of a symmetric matrix MUMPS takes the lower half only. */
static void read_matrix(const char *path, DMUMPS_STRUC_C *id) {
    FILE *file = fopen(path, "r");
    char line[256];
    int rows, columns;
    long entries;
    if (!file) fail("cannot open the matrix", 0);
    do {
        if (!fgets(line, sizeof line, file)) fail("no header", 0);
    } while (line[0] == '%');
    if (sscanf(line, "%d %d %ld", &rows, &columns, &entries) != 3) fail("bad header", 0);
    id->n = rows;
    id->nnz = entries;
    id->irn = malloc(entries * sizeof *id->irn);
    id->jcn = malloc(entries * sizeof *id->jcn);
    id->a = malloc(entries * sizeof *id->a);
    id->nnz = 0;
    for (long k = 0; k < entries; k++) {
        long at = id->nnz;
        if (fscanf(file, "%d %d %lf", &id->irn[at], &id->jcn[at], &id->a[at]) != 3) fail("bad entry", 0);
        id->nnz += id->sym == 0 || id->irn[at] >= id->jcn[at];
    }
    fclose(file);
}

static double run(DMUMPS_STRUC_C *id, int job) {
    double start = cpu();
    id->job = job;
    dmumps_c(id);
    if (id->infog[0] < 0) fail("MUMPS failed", id->infog[0]);
    return cpu() - start;
}

static double backward_error(const DMUMPS_STRUC_C *id, const double *x) {
    double *residual = malloc(id->n * sizeof *residual), *bound = malloc(id->n * sizeof *bound), worst = 0;
    for (int i = 0; i < id->n; i++) residual[i] = bound[i] = 1;
    for (long k = 0; k < id->nnz; k++) {
        double term = id->a[k] * x[id->jcn[k] - 1];
        residual[id->irn[k] - 1] -= term;
        bound[id->irn[k] - 1] += fabs(term);
        if (id->sym != 0 && id->irn[k] != id->jcn[k]) {
            double mirrored = id->a[k] * x[id->irn[k] - 1];
            residual[id->jcn[k] - 1] -= mirrored;
            bound[id->jcn[k] - 1] += fabs(mirrored);
        }
    }
    for (int i = 0; i < id->n; i++) worst = fmax(worst, fabs(residual[i]) / bound[i]);
    free(residual);
    free(bound);
    return worst;
}

int main(int argc, char **argv) {
    DMUMPS_STRUC_C id;
    struct rusage usage;
    if (argc != 2 && argc != 3) fail("usage: mumps matrix.mtx [symmetric]", argc);
    memset(&id, 0, sizeof id);
    id.sym = argc == 3 ? 2 : 0; /* not known to be definite */
    id.par = 1;
    id.comm_fortran = -987654;
    run(&id, -1);
    read_matrix(argv[1], &id);
    for (int k = 0; k < 4; k++) id.icntl[k] = k == 3 ? 0 : -1; /* silent */
    id.icntl[6] = 5;                                           /* METIS */
    double *x = malloc(id.n * sizeof *x);
    double analysis = run(&id, 1), first = run(&id, 2), second = run(&id, 2), solve = 0;
    for (int round = 0; round < 10; round++) {
        for (int i = 0; i < id.n; i++) x[i] = 1;
        id.rhs = x;
        solve += 0.1 * run(&id, 3);
    }
    getrusage(RUSAGE_SELF, &usage);
    printf("mumps%s %d %.4f %.4f %.4f %.5f %ld %.1e\n", id.sym ? "-ldlt" : "", id.n, analysis, first, second, solve, usage.ru_maxrss,
           backward_error(&id, x));
    return 0;
}
