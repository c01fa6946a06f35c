#include <stdio.h>
#include <string.h>
int main(int argc, char **argv) {
    char path[4096], line[4096], name[99]; int nx = 0, ny = 1, at = 0; double lx, ly, f, sum = 0, peak = 0;
    if (argc < 3 || !snprintf(path, sizeof path, "%s/index.csv", argv[1])) return 2;
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, "%98[^,],%d,%d,%lf,%lf", name, &nx, &ny, &lx, &ly) == 5 && !strcmp(name, argv[2])) break;
    snprintf(path, sizeof path, "%s/data/%s.pressure.f64", argv[1], argv[2]);
    if (!(file = fopen(path, "rb"))) return 2;
    for (int k = 0; fread(&f, sizeof f, 1, file) == 1; k++)
        if (sum += f, f > peak) peak = f, at = k; /* element k / ny along x, k % ny along y */
    printf("%s: %d x %d, load %.9g N, ", name, nx, ny, sum * lx * ly / (nx * ny));
    return printf("peak %.9g Pa at %d, %d\n", peak, at / ny, at % ny) < 0;
}
