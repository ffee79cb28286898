/* SPDX-License-Identifier: BSD-3-Clause */
/* Snapshots of particles: read two or three times, so that a file of any length needs the memory of
 * one. */
#include "snapshots.h"
#include "outcome.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "text.h"

static const char header[] = "time,id,radius,x,y,z,";

enum { LINE = 1024, PARTICLES_MAX = 1 << 22, BYTES_MAX = 16 << 20, ABSENT = 65535, SETS = 64 };

/* What is taken from a row. */
typedef struct particle {
    double time;
    double id;
    double radius;
    double r[3];
    double force;     /* 0: no such column */
    const char *name; /* of its set, in the line */
    size_t length;
} particle;

/* A file, and which of its columns are set and force (0: none). */
typedef struct rows {
    FILE *file;
    int set, force;
    char line[LINE];
} rows;

typedef struct pack {
    double low[3], high[3];
    double first, last; /* ids */
    size_t snapshots;
    size_t stride; /* every so many snapshots are written */
    double most;   /* of the forces */
    char names[SETS][64];
    size_t sets;
    float *radii;
    uint16_t *places;
    uint16_t *forces; /* parts of the largest */
    uint8_t *set;
} pack;

void base64_put(FILE *file, const void *data, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *at = data;
    char text[4096];
    size_t count = 0;
    for (size_t k = 0; k < size; k += 3) {
        const size_t left = size - k;
        const uint32_t bits = (uint32_t)at[k] << 16 | (left > 1 ? (uint32_t)at[k + 1] << 8 : 0) |
                              (left > 2 ? (uint32_t)at[k + 2] : 0);
        text[count++] = digits[bits >> 18];
        text[count++] = digits[bits >> 12 & 63];
        text[count++] = left > 1 ? digits[bits >> 6 & 63] : '=';
        text[count++] = left > 2 ? digits[bits & 63] : '=';
        if (count == sizeof text) {
            fwrite(text, 1, count, file);
            count = 0;
        }
    }
    fwrite(text, 1, count, file);
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

/* Set and force of a row, whose first six columns end at `at`. */
static void read_more(const rows *in, const char *at, particle *g)
{
    g->force = 0.0;
    g->name = "";
    g->length = 0;
    for (int column = 6; *at; ++column) {
        const size_t length = strcspn(at, ",\r\n");
        if (column == in->set) {
            g->name = at;
            g->length = length;
        } else if (column == in->force) {
            g->force = strtod(at, NULL);
        }
        at += length + (at[length] == ',');
        if (*at == '\r' || *at == '\n') {
            break;
        }
    }
    g->force = isfinite(g->force) ? fabs(g->force) : 0.0;
}

static int read_particle(rows *in, particle *g)
{
    double *const into[6] = {&g->time, &g->id, &g->radius, &g->r[0], &g->r[1], &g->r[2]};
    while (fgets(in->line, LINE, in->file)) {
        char *at = in->line;
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
            read_more(in, at, g);
            return 1;
        }
    }
    return 0;
}

static int open_rows(rows *in, const char *path)
{
    in->file = se3di_file_open(path);
    in->set = in->force = 0;
    if (!in->file || !fgets(in->line, LINE, in->file)) {
        if (in->file) {
            fclose(in->file);
        }
        return 0;
    }
    int column = 0;
    for (const char *name = in->line; *name; ++column) {
        const size_t length = strcspn(name, ",\r\n");
        in->set = length == 3 && memcmp(name, "set", 3) == 0 ? column : in->set;
        in->force = length == 5 && memcmp(name, "force", 5) == 0 ? column : in->force;
        name += length + (name[length] == ',');
        if (*name == '\r' || *name == '\n') {
            break;
        }
    }
    return 1;
}

/* The number of a set; of more than there is room for, the last one. */
static uint8_t find_set(pack *p, const particle *g)
{
    size_t k = 0;
    const size_t length = g->length < sizeof *p->names ? g->length : sizeof *p->names - 1;
    while (k < p->sets &&
           (strlen(p->names[k]) != length || memcmp(p->names[k], g->name, length) != 0)) {
        ++k;
    }
    if (k == p->sets && k < SETS) {
        memcpy(p->names[k], g->name, length);
        p->names[k][length] = '\0';
        ++p->sets;
    }
    return (uint8_t)(k < SETS ? k : SETS - 1);
}

/* The first reading: how many, and within which box. */
static int survey(pack *p, const char *path)
{
    particle g;
    double time = 0.0;
    rows in;
    if (!open_rows(&in, path)) {
        return 0;
    }
    for (size_t count = 0; read_particle(&in, &g); ++count) {
        if (count == 0) {
            p->first = p->last = g.id;
            memcpy(p->low, g.r, sizeof g.r);
            memcpy(p->high, g.r, sizeof g.r);
        }
        p->snapshots += count == 0 || g.time > time;
        p->most = fmax(p->most, g.force);
        find_set(p, &g);
        time = g.time;
        p->first = fmin(p->first, g.id);
        p->last = fmax(p->last, g.id);
        for (int i = 0; i < 3; ++i) {
            p->low[i] = fmin(p->low[i], g.r[i]);
            p->high[i] = fmax(p->high[i], g.r[i]);
        }
    }
    fclose(in.file);
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
    p->set[k] = find_set(p, g);
    p->forces[k] = p->most > 0.0 ? (uint16_t)lround(g->force / p->most * ABSENT) : 0;
}

static size_t count_of(const pack *p)
{
    return (size_t)(p->last - p->first) + 1;
}

static void put_snapshot(FILE *out, const pack *p, size_t number, const uint16_t *what, size_t size)
{
    if (number > 0 && (number - 1) % p->stride == 0) {
        fputs(number > 1 ? ",\"" : "\"", out);
        base64_put(out, what, size * count_of(p));
        fputc('"', out);
    }
}

/* Places (`width` 3) or forces (1) of all snapshots that are written. */
static void put_frames(FILE *out, pack *p, rows *in, int width, double *times, size_t *kept)
{
    const size_t size = (size_t)width * sizeof *p->places;
    uint16_t *what = width == 3 ? p->places : p->forces;
    particle g;
    size_t number = 0;
    double time = 0.0;
    *kept = 0;
    while (read_particle(in, &g)) {
        if (number == 0 || g.time > time) {
            put_snapshot(out, p, number++, what, size);
            memset(what, width == 3 ? 0xff : 0, size * count_of(p));
            time = g.time;
            if ((number - 1) % p->stride == 0) {
                times[(*kept)++] = time;
            }
        }
        put_place(p, &g);
    }
    put_snapshot(out, p, number, what, size);
}

/* The colours that come along: forces and sets, as far as the file tells them. */
static int put_colours(FILE *out, pack *p, const char *path, double *times)
{
    rows in;
    size_t kept = 0;
    if (!open_rows(&in, path)) {
        return 0;
    }
    if (in.force > 0 && p->most > 0.0) {
        fprintf(out, ",\"most\":%.9g,\"forces\":[", p->most);
        put_frames(out, p, &in, 1, times, &kept);
        fputc(']', out);
    }
    fclose(in.file);
    if (p->sets > 1) {
        fputs(",\"sets\":[", out);
        for (size_t k = 0; k < p->sets; ++k) {
            fputs(k > 0 ? "," : "", out);
            text_put_script(out, p->names[k]);
        }
        fputs("],\"set\":\"", out);
        base64_put(out, p->set, count_of(p));
        fputc('"', out);
    }
    return 1;
}

/* The second reading: the snapshots, then what belongs to all. */
static int put_all(FILE *out, pack *p, const char *path, double *times)
{
    rows in;
    size_t kept = 0;
    if (!open_rows(&in, path)) {
        return 0;
    }
    fputs("{\"frames\":[", out);
    put_frames(out, p, &in, 3, times, &kept);
    fclose(in.file);
    fprintf(out, "],\"count\":%zu,\"radii\":\"", count_of(p));
    base64_put(out, p->radii, sizeof *p->radii * count_of(p));
    fputs("\",\"times\":[", out);
    for (size_t k = 0; k < kept; ++k) {
        fprintf(out, k > 0 ? ",%.9g" : "%.9g", times[k]);
    }
    fprintf(out, "],\"low\":[%.9g,%.9g,%.9g],\"high\":[%.9g,%.9g,%.9g]", p->low[0], p->low[1],
            p->low[2], p->high[0], p->high[1], p->high[2]);
    const int good = put_colours(out, p, path, times);
    fputc('}', out);
    return good;
}

int snapshots_put(FILE *out, const char *command, const char *path)
{
    pack p;
    memset(&p, 0, sizeof p);
    errno = 0;
    if (!survey(&p, path)) {
        complain("se3d %s: %s: %s\n", command, path, strerror(errno));
        return 0;
    }
    if (p.snapshots == 0 || !(p.last - p.first < PARTICLES_MAX)) {
        fputs("null", out);
        return 1;
    }
    p.stride = 1 + 8 * count_of(&p) * p.snapshots / BYTES_MAX;
    p.radii = calloc(count_of(&p), sizeof *p.radii);
    p.places = malloc(6 * count_of(&p));
    p.forces = malloc(2 * count_of(&p));
    p.set = calloc(count_of(&p), 1);
    double *times = malloc(p.snapshots * sizeof *times);
    const int good = p.radii && p.places && p.forces && p.set && times;
    if (!good) {
        complain("se3d %s: %s: out of memory\n", command, path);
    } else if (!put_all(out, &p, path, times)) {
        complain("se3d %s: %s: cannot be read\n", command, path);
    }
    free(p.radii);
    free(p.places);
    free(p.forces);
    free(p.set);
    free(times);
    return good;
}
