/* The driver of gsp/kernels/compiled/evaluation.py in C, for the comparison of speeds only. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LANES 8
#define ROW (6 * LANES)
#define CHUNK 4
#define POSE 14
#define UNDEFINED 13
#define GEOMETRY 13
#define UPPER 27
#define SPECTRUM 16

typedef double vector __attribute__((vector_size(64), aligned(8), may_alias));
typedef long mask __attribute__((vector_size(64), aligned(8), may_alias));

static inline vector load(const double *p) { return *(const vector *)p; }
static inline void store(double *p, vector x) { *(vector *)p = x; }
static inline vector spread(double x) { return (vector){x, x, x, x, x, x, x, x}; }
static inline vector choose(mask m, vector a, vector b) {
    return (vector)(((mask)a & m) | ((mask)b & ~m));
}
static inline vector root(vector x) {
    vector r;
    for (int i = 0; i < LANES; i++) r[i] = sqrt(x[i]);
    return r;
}
static inline int any(vector x) {
    for (int i = 0; i < LANES; i++)
        if (x[i] > 0.0) return 1;
    return 0;
}

/* STAGES */

typedef struct {
    double pose[POSE * LANES], frame[2 * ROW], upper[UPPER * LANES], factors[ROW], sums[ROW];
    double spectrum[SPECTRUM * LANES], result[3 * LANES];
} block;

static void triangle(block *b, double *matrix, long n) {
    memset(matrix + n * ROW, 0, sizeof(double) * CHUNK * ROW);
    memset(b->sums, 0, sizeof b->sums);
    for (long column = 0; column < 6; column++) {
        for (long row = column; row < n; row += CHUNK)
            sweep[column](matrix + row * ROW, b->factors, b->sums);
        pivot[column](matrix + column * ROW, b->sums, b->factors, b->upper);
    }
}

static void solve(block *b, double *matrix, long n) {
    if (n > 6) {
        triangle(b, matrix, n);
        for (int i = 0, k = 0; i < 6; i++)
            for (int j = 0; j < 6; j++) {
                double *to = matrix + (6 * i + j) * LANES;
                if (j < i) memset(to, 0, sizeof(double) * LANES);
                else memcpy(to, b->upper + LANES * k++, sizeof(double) * LANES);
            }
    }
    bidiagonal(matrix, b->spectrum);
    laguerre(b->spectrum);
    extremes(b->spectrum, b->result);
}

static void put(const block *b, int from, double *out, long count) {
    for (long i = 0; i < count; i++)
        out[i] = b->pose[UNDEFINED * LANES + i] == 0.0 ? b->result[from * LANES + i] : NAN;
}

void evaluate_block(const double *position, const double *rotation, long n, const long *kinds,
                    long n_legs, double *geometry, double *ellipsoid, double length, long problems,
                    double *out) {
    long n_rows = 0, n_passive = 0;
    for (long leg = 0; leg < n_legs; leg++) {
        n_rows += N_ACTUATORS[kinds[leg]];
        n_passive += N_PASSIVE[kinds[leg]];
    }
    block *b = malloc(sizeof *b);
    double *rows = malloc(sizeof(double) * n_rows * ROW);
    double *matrix = malloc(sizeof(double) * (n_rows + CHUNK) * ROW);
    double *tall = malloc(sizeof(double) * (n_passive + CHUNK) * ROW);
    for (long start = 0; start < n; start += LANES) {
        long count = n - start < LANES ? n - start : LANES;
        for (long i = 0; i < LANES; i++) {
            long at = start + (i < count ? i : count - 1);
            for (int k = 0; k < 3; k++) b->pose[k * LANES + i] = position[3 * at + k];
            for (int k = 0; k < 9; k++) b->pose[(3 + k) * LANES + i] = rotation[9 * at + k];
        }
        reach(b->pose);
        double *to = rows;
        for (long leg = 0; leg < n_legs; leg++) {
            actuators[kinds[leg]](b->pose, geometry + leg * GEOMETRY, to, length);
            to += N_ACTUATORS[kinds[leg]] * ROW;
        }
        if (problems & 1) {
            for (long i = 0; i < n_rows * ROW; i += ROW)
                homogeneous_row(rows + i, matrix + i, 1.0 / length);
            solve(b, matrix, n_rows);
            for (int k = 0; k < 3; k++) put(b, k, out + k * n + start, count);
        }
        if (problems & 2) {
            ellipsoid_frame(b->pose, ellipsoid, b->frame);
            for (long i = 0; i < n_rows * ROW; i += ROW)
                ellipsoid_row(rows + i, b->frame, matrix + i);
            solve(b, matrix, n_rows);
            put(b, 0, out + 3 * n + start, count);
        }
        if (problems & 4) {
            to = tall;
            for (long leg = 0; leg < n_legs; leg++) {
                passive[kinds[leg]](b->pose, geometry + leg * GEOMETRY, to, length);
                to += N_PASSIVE[kinds[leg]] * ROW;
            }
            triangle(b, tall, n_passive);
            for (long i = 0; i < n_rows * ROW; i += ROW)
                solved_row(rows + i, b->upper, matrix + i);
            solve(b, matrix, n_rows);
            put(b, 0, out + 4 * n + start, count);
        }
    }
    free(b), free(rows), free(matrix), free(tall);
}
