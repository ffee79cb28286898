/* SPDX-License-Identifier: BSD-3-Clause */
/* Snapshots of particles: read twice, so that a file of any length needs the memory of one. */
#include "snapshots.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"

static const char header[] = "time,id,radius,x,y,z,";

enum { LINE = 1024, PARTICLES_MAX = 1 << 22, BYTES_MAX = 16 << 20, ABSENT = 65535 };

/* The beginning of a row. */
typedef struct particle {
    double time;
    double id;
    double radius;
    double r[3];
} particle;

typedef struct pack {
    double low[3], high[3];
    double first, last; /* ids */
    size_t snapshots;
    size_t stride; /* every so many snapshots are written */
    float *radii;
    uint16_t *places;
} pack;

void base64_put(FILE *file, const void *data, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *at = data;
    for (size_t k = 0; k < size; k += 3) {
        const size_t left = size - k;
        const uint32_t bits = (uint32_t)at[k] << 16 | (left > 1 ? (uint32_t)at[k + 1] << 8 : 0) |
                              (left > 2 ? (uint32_t)at[k + 2] : 0);
        fputc(digits[bits >> 18], file);
        fputc(digits[bits >> 12 & 63], file);
        fputc(left > 1 ? digits[bits >> 6 & 63] : '=', file);
        fputc(left > 2 ? digits[bits & 63] : '=', file);
    }
}

int snapshots_is(const char *path)
{
    char line[LINE];
    FILE *file = se3di_file_open(path);
    const int is = file && fgets(line, LINE, file) && strncmp(line, header, sizeof header - 1) == 0;
    if (file) {
        fclose(file);
    }
    return is;
}

static int read_particle(FILE *file, particle *g)
{
    char line[LINE];
    double *const into[6] = {&g->time, &g->id, &g->radius, &g->r[0], &g->r[1], &g->r[2]};
    while (fgets(line, LINE, file)) {
        char *at = line;
        int count = 0;
        for (; count < 6; ++count) {
            char *end = at;
            *into[count] = strtod(at, &end);
            if (end == at || *end != ',' || !isfinite(*into[count])) {
                break;
            }
            at = end + 1;
        }
        if (count == 6) {
            return 1;
        }
    }
    return 0;
}

static FILE *open_rows(const char *path)
{
    char line[LINE];
    FILE *file = se3di_file_open(path);
    if (file && !fgets(line, LINE, file)) {
        fclose(file);
        file = NULL;
    }
    return file;
}

/* The first reading: how many, and within which box. */
static int survey(pack *p, const char *path)
{
    particle g;
    double time = 0.0;
    FILE *file = open_rows(path);
    if (!file) {
        return 0;
    }
    for (size_t rows = 0; read_particle(file, &g); ++rows) {
        if (rows == 0) {
            p->first = p->last = g.id;
            memcpy(p->low, g.r, sizeof g.r);
            memcpy(p->high, g.r, sizeof g.r);
        }
        p->snapshots += rows == 0 || g.time > time;
        time = g.time;
        p->first = fmin(p->first, g.id);
        p->last = fmax(p->last, g.id);
        for (int i = 0; i < 3; ++i) {
            p->low[i] = fmin(p->low[i], g.r[i]);
            p->high[i] = fmax(p->high[i], g.r[i]);
        }
    }
    fclose(file);
    return 1;
}

static void put_place(pack *p, const particle *g)
{
    const size_t k = (size_t)(g->id - p->first);
    p->radii[k] = (float)g->radius;
    for (int i = 0; i < 3; ++i) {
        const double width = p->high[i] - p->low[i];
        const double part = width > 0.0 ? (g->r[i] - p->low[i]) / width : 0.0;
        p->places[3 * k + (size_t)i] = (uint16_t)lround(part * (ABSENT - 1));
    }
}

static size_t count_of(const pack *p)
{
    return (size_t)(p->last - p->first) + 1;
}

static void put_snapshot(FILE *out, const pack *p, size_t number)
{
    if (number > 0 && (number - 1) % p->stride == 0) {
        fputs(number > 1 ? ",\"" : "\"", out);
        base64_put(out, p->places, 6 * count_of(p));
        fputc('"', out);
    }
}

/* The second reading: the snapshots, then what belongs to all. */
static void put_all(FILE *out, pack *p, FILE *file, double *times)
{
    particle g;
    size_t number = 0;
    size_t kept = 0;
    double time = 0.0;
    fputs("{\"frames\":[", out);
    while (read_particle(file, &g)) {
        if (number == 0 || g.time > time) {
            put_snapshot(out, p, number++);
            memset(p->places, 0xff, 6 * count_of(p));
            time = g.time;
            if ((number - 1) % p->stride == 0) {
                times[kept++] = time;
            }
        }
        put_place(p, &g);
    }
    put_snapshot(out, p, number);
    fprintf(out, "],\"count\":%zu,\"radii\":\"", count_of(p));
    base64_put(out, p->radii, sizeof *p->radii * count_of(p));
    fputs("\",\"times\":[", out);
    for (size_t k = 0; k < kept; ++k) {
        fprintf(out, k > 0 ? ",%.9g" : "%.9g", times[k]);
    }
    fprintf(out, "],\"low\":[%.9g,%.9g,%.9g],\"high\":[%.9g,%.9g,%.9g]}", p->low[0], p->low[1],
            p->low[2], p->high[0], p->high[1], p->high[2]);
}

int snapshots_put(FILE *out, const char *command, const char *path)
{
    pack p;
    memset(&p, 0, sizeof p);
    errno = 0;
    if (!survey(&p, path)) {
        fprintf(stderr, "se3d %s: %s: %s\n", command, path, strerror(errno));
        return 0;
    }
    if (p.snapshots == 0 || !(p.last - p.first < PARTICLES_MAX)) {
        fputs("null", out);
        return 1;
    }
    p.stride = 1 + 6 * count_of(&p) * p.snapshots / BYTES_MAX;
    p.radii = calloc(count_of(&p), sizeof *p.radii);
    p.places = malloc(6 * count_of(&p));
    double *times = malloc(p.snapshots * sizeof *times);
    FILE *file = open_rows(path);
    const int good = file && p.radii && p.places && times;
    if (good) {
        put_all(out, &p, file, times);
    } else {
        fprintf(stderr, "se3d %s: %s: out of memory\n", command, path);
    }
    if (file) {
        fclose(file);
    }
    free(p.radii);
    free(p.places);
    free(times);
    return good;
}
