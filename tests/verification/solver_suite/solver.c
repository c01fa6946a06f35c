/* A contact solver in another language, for a free half-space without coupling: conjugate gradients on the contact
   set (Polonsky and Keer 1999), dense influence. Usage: solver DIRECTORY, see verification/solver_suite/command.py */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#define EACH for (int i = 0; i < n; i++)
static int M, n;
static double *table; /* displacement by unit pressure on one element, at whole offsets */

static double number(const char *header, const char *key) {
    const char *at = strstr(header, key);
    return at ? atof(strchr(at, ':') + 1) : (exit(3), 0.0);
}
static FILE *file(const char *directory, const char *name, const char *mode) {
    char path[4096];
    FILE *opened = snprintf(path, sizeof path, "%s/%s", directory, name) > 0 ? fopen(path, mode) : NULL;
    return opened ? opened : (exit(2), NULL);
}
static double corner(double x, double y) { return x * asinh(y / fabs(x)) + y * asinh(x / fabs(y)); }
static void displace(const double *f, double *u) {
    EACH u[i] = 0;
    for (int s = 0; s < n; s++)
        if (f[s] != 0) EACH u[i] += f[s] * table[abs(i / M - s / M) * M + abs(i % M - s % M)];
}
int main(int argc, char **argv) {
    char text[4096] = "", *directory = argv[argc - 1];
    if (!fread(text, 1, sizeof text - 1, file(directory, "problem.json", "r"))) return 2;
    if (number(text, "\"periodic\"") || number(text, "\"friction\"")) return 4; /* not offered */
    int by_load = strstr(text, "\"load\"") != NULL;
    double h = number(text, "\"spacing\""), E = number(text, "\"reduced_modulus\""), value = number(text, "\"value\"");
    M = (int)number(text, "\"M\""), n = M * M;
    double *f = calloc(6 * n, sizeof *f), *gap = f + n, *v = f + 2 * n, *t = f + 3 * n, *r = f + 4 * n;
    FILE *heights = file(directory, "gap.csv", "r"), *answer;
    table = f + 5 * n;
    EACH {
        double x = i / M + 0.5, y = i % M + 0.5, integral = corner(x, y) - corner(x - 1, y) - corner(x, y - 1);
        table[i] = h / (acos(-1) * E) * (integral + corner(x - 1, y - 1));
        if (fscanf(heights, "%lf%*[,\n]", &gap[i]) != 1) return 2;
        f[i] = by_load ? value / (n * h * h) : gap[i] < value ? 1e-3 * E * value / (M * h) : 0;
    }
    double before = 1, conjugate = 0, error = 1, level = value, count = 0, tolerance = number(text, "\"tolerance\"");
    for (int step = 0; step < 5000; step++) {
        double sum = 0, mean = 0, least = 1e300, G = 0, energy = 0, gaps = 0, up = 0, down = 0;
        level = value, count = 0;
        displace(f, v);
        EACH energy += f[i] * v[i] / 2, v[i] += gap[i], least = fmin(least, v[i]), sum += f[i];
        EACH if (f[i] > 0) count++, mean += v[i];
        if (by_load) level = mean / count;
        EACH gaps += f[i] * (v[i] - (by_load ? least : level)), v[i] -= level, G += f[i] > 0 ? v[i] * v[i] : 0;
        error = (fabs(gaps) + (by_load ? 0 : fmax(0, level - least) * sum)) / energy;
        if (error < 0.5 * tolerance) break;
        EACH t[i] = f[i] > 0 ? v[i] + conjugate * G / before * t[i] : 0;
        displace(t, r);
        before = G, conjugate = 1, mean = sum = 0;
        if (by_load) EACH mean += f[i] > 0 ? r[i] / count : 0;
        EACH up += v[i] * t[i], down += (r[i] - mean) * t[i];
        EACH f[i] = fmax(0, f[i] - up / down * t[i]);
        EACH if (f[i] == 0 && v[i] < 0) f[i] = -up / down * v[i], conjugate = 0;
        EACH sum += f[i] * h * h;
        if (by_load) EACH f[i] *= value / sum;
    }
    if (error >= tolerance) return 1;
    answer = file(directory, "pressure.csv", "w");
    EACH fprintf(answer, "%.17g%c", f[i], i % M == M - 1 ? '\n' : ',');
    fclose(answer);
    answer = file(directory, "answer.json", "w"); /* numbers beside the pressures are optional */
    fprintf(answer, "{\"converged\": true, \"approach\": %.17g, \"contact_area\": %.17g}\n", level, count * h * h);
    return fclose(answer);
}
