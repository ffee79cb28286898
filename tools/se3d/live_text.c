/* SPDX-License-Identifier: BSD-3-Clause */
#define _XOPEN_SOURCE 700

#include "live_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "snapshots.h"
#include "table.h"
#include "text.h"

static void put_numbers(FILE *file, const char *name, const double *values, size_t count)
{
    fprintf(file, ",\"%s\":[", name);
    for (size_t k = 0; k < count; ++k) {
        fprintf(file, isfinite(values[k]) ? "%s%.7g" : "%snull", k > 0 ? "," : "", values[k]);
    }
    fputs("]", file);
}

char *live_text_take(FILE *file, char **data)
{
    const int good = !ferror(file);
    if (fclose(file) == 0 && good) {
        return *data;
    }
    free(*data);
    return NULL;
}

/* Centres and radii of all particles, as 32-bit numbers. */
static void put_particles(FILE *file, const se3di_live *model)
{
    const size_t count = se3di_live_count_particles(model);
    float *places = calloc(4 * count + 1, sizeof *places);
    if (places && se3di_live_get_particles(model, places)) {
        fputs(",\"grains\":\"", file);
        base64_put(file, places, 4 * count * sizeof *places);
        fputs("\"", file);
    }
    free(places);
}

static void put_state(FILE *file, se3di_live *model, const live_status *s, double *numbers)
{
    char trouble[2 * SE3DI_LIVE_MESSAGE_SIZE + 2];
    const size_t places = se3di_live_count_places(model);
    const size_t columns = se3di_live_count_columns(model);
    const size_t sliders = se3di_live_count_sliders(model);
    fprintf(file, "{\"sequence\":%llu,\"version\":%llu,\"list\":%llu,\"t\":%.12g",
            (unsigned long long)s->sequence, (unsigned long long)s->version,
            (unsigned long long)s->list, se3di_live_get_time(model));
    fprintf(file, ",\"running\":%s,\"speed\":%.9g,\"trouble\":", s->running ? "true" : "false",
            s->speed);
    snprintf(trouble, sizeof trouble, "%s%s%s", s->file_trouble,
             s->file_trouble[0] && s->run_trouble[0] ? "\n" : "", s->run_trouble);
    text_put_json(file, trouble);
    se3di_live_get_places(model, numbers);
    put_numbers(file, "places", numbers, places);
    se3di_live_get_values(model, numbers);
    put_numbers(file, "values", numbers, columns);
    for (size_t k = 0; k < sliders; ++k) {
        numbers[k] = se3di_live_get_slider(model, k)->value;
    }
    put_numbers(file, "numbers", numbers, sliders);
    put_particles(file, model);
    fputs("}", file);
}

char *live_text_of_state(se3di_live *model, const live_status *s, size_t *size)
{
    char *data = NULL;
    double *numbers = calloc(se3di_live_count_places(model) + se3di_live_count_columns(model) +
                                 se3di_live_count_sliders(model) + 1,
                             sizeof *numbers);
    FILE *file = numbers ? open_memstream(&data, size) : NULL;
    if (file) {
        put_state(file, model, s, numbers);
        data = live_text_take(file, &data);
    }
    free(numbers);
    return data;
}

/* The JSON of binary glTF, for the units that it names. @return NULL: out of memory. */
static char *copy_json(const char *glb, size_t size)
{
    size_t length = 0;
    for (int k = 3; k >= 0 && size > 20; --k) {
        length = length << 8 | (unsigned char)glb[12 + k];
    }
    length = length < size - 20 ? length : 0;
    char *json = malloc(length + 1);
    if (json) {
        memcpy(json, glb + 20, length);
        json[length] = '\0';
    }
    return json;
}

static void put_results(FILE *file, const se3di_live *model, char *json)
{
    const table units = {.scene = json};
    char unit[60];
    double box[6];
    fputs(",\"results\":{\"names\":[\"time\"", file);
    for (size_t k = 0; k < se3di_live_count_columns(model); ++k) {
        fputs(",", file);
        text_put_json(file, se3di_live_get_column(model, k));
    }
    fputs("],\"units\":[\"s\"", file);
    for (size_t k = 0; k < se3di_live_count_columns(model); ++k) {
        fputs(",", file);
        text_put_json(file,
                      table_get_unit(&units, se3di_live_get_column(model, k), unit, sizeof unit));
    }
    fputs("]},\"sliders\":[", file);
    for (size_t k = 0; k < se3di_live_count_sliders(model); ++k) {
        const se3di_live_slider *slider = se3di_live_get_slider(model, k);
        fputs(k > 0 ? ",{\"name\":" : "{\"name\":", file);
        text_put_json(file, slider->name);
        fputs(",\"unit\":", file);
        text_put_json(file, slider->unit);
        fprintf(file, ",\"start\":%.12g}", slider->start);
    }
    fputs("]", file);
    if (se3di_live_get_particle_box(model, box, box + 3)) {
        put_numbers(file, "box", box, 6);
    }
    fputs("}", file);
}

char *live_text_of_sliders(const se3di_live *model)
{
    char *data = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&data, &size);
    for (size_t k = 0; file && k < se3di_live_count_sliders(model); ++k) {
        fprintf(file, "%s\n", se3di_live_get_slider(model, k)->name);
    }
    return file ? live_text_take(file, &data) : NULL;
}

char *live_text_of_scene(se3di_live *model)
{
    char *glb = NULL;
    char *data = NULL;
    size_t glb_size = 0;
    size_t size = 0;
    FILE *binary = open_memstream(&glb, &glb_size);
    const int good = binary && se3di_live_put_scene(model, binary);
    if (!binary || fclose(binary) != 0 || !good || glb_size <= 20) {
        free(glb);
        return NULL;
    }
    char *json = copy_json(glb, glb_size);
    FILE *file = json ? open_memstream(&data, &size) : NULL;
    if (file) {
        fputs("\"glb\":\"", file);
        base64_put(file, glb, glb_size);
        fputs("\"", file);
        put_results(file, model, json);
        data = live_text_take(file, &data);
    }
    free(json);
    free(glb);
    return data;
}
