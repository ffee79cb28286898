/* SPDX-License-Identifier: BSD-3-Clause */
/* .vtp and .vti files: VTK's PolyData and ImageData in XML with appended raw data. Every array is
 * preceded by its size in bytes, 64 bits. */
#include "io/write/vtk_file.h"

#include <stdint.h>
#include <string.h>

#include "io/base/file.h"
#include "io/base/number.h"

enum { BLOCK = 4096 };

static double value_of(const se3di_vtk_array *a, size_t k, size_t i)
{
    return a->values ? a->values[k * a->stride + i] : a->first + (double)k * a->step;
}

static void put_little(unsigned char *at, uint64_t bits, size_t size)
{
    for (size_t k = 0; k < size; ++k) {
        at[k] = (unsigned char)(bits >> (8 * k));
    }
}

static void put_data(FILE *file, const se3di_vtk_array *a)
{
    unsigned char block[4 * BLOCK];
    size_t used = 0;
    put_little(block, 4 * (uint64_t)a->count * a->width, 8);
    fwrite(block, 1, 8, file);
    for (size_t k = 0; k < a->count; ++k) {
        for (size_t i = 0; i < a->width; ++i) {
            const double value = value_of(a, k, i);
            const float single = (float)value;
            uint32_t bits = 0;
            memcpy(&bits, &single, sizeof bits);
            put_little(block + used, a->whole ? (uint32_t)(int32_t)value : bits, 4);
            used += 4;
            if (used == sizeof block) {
                fwrite(block, 1, used, file);
                used = 0;
            }
        }
    }
    fwrite(block, 1, used, file);
}

/* "0 3 0 4 0 5" of a grid of 3 x 4 x 5 cells. */
static void put_extent(FILE *file, const char *name, const se3di_vtk_grid *grid)
{
    fprintf(file, " %s=\"0 %d 0 %d 0 %d\"", name, (int)grid->cells[0], (int)grid->cells[1],
            (int)grid->cells[2]);
}

static void put_triple(FILE *file, const char *name, const double values[3])
{
    char text[3][48];
    for (int k = 0; k < 3; ++k) {
        text[k][se3di_number_format(values[k], text[k])] = '\0';
    }
    fprintf(file, " %s=\"%s %s %s\"", name, text[0], text[1], text[2]);
}

static const char *type_of(const se3di_vtk_file *f)
{
    return f->grid ? "ImageData" : "PolyData";
}

static void put_piece(FILE *file, const se3di_vtk_file *f)
{
    if (f->grid) {
        fputs("<ImageData", file);
        put_extent(file, "WholeExtent", f->grid);
        put_triple(file, "Origin", f->grid->origin);
        put_triple(file, "Spacing", f->grid->spacing);
        fputs(">\n<Piece", file);
        put_extent(file, "Extent", f->grid);
        fputs(">\n", file);
        return;
    }
    fprintf(file,
            "<PolyData>\n<Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\" "
            "NumberOfLines=\"%zu\" NumberOfStrips=\"0\" NumberOfPolys=\"%zu\">\n",
            f->points, f->verts, f->lines, f->polys);
}

static void put_head(FILE *file, const se3di_vtk_file *f)
{
    static const char *const names[] = {"PointData", "CellData", "Points",
                                        "Verts",     "Lines",    "Polys"};
    const size_t sections = f->grid ? SE3DI_VTK_CELL_DATA + 1 : SE3DI_VTK_SECTION_COUNT;
    size_t offset = 0;
    size_t k = 0;
    fprintf(file,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"%s\" version=\"1.0\" "
            "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n",
            type_of(f));
    put_piece(file, f);
    for (size_t s = 0; s < sections; ++s) {
        fprintf(file, "<%s>\n", names[s]);
        for (; k < f->array_count && (size_t)f->arrays[k].section == s; ++k) {
            const se3di_vtk_array *a = &f->arrays[k];
            fprintf(file,
                    "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%zu\" "
                    "format=\"appended\" offset=\"%zu\"/>\n",
                    a->whole ? "Int32" : "Float32", a->name, a->width, offset);
            offset += 8 + 4 * a->count * a->width;
        }
        fprintf(file, "</%s>\n", names[s]);
    }
    fprintf(file, "</Piece>\n</%s>\n<AppendedData encoding=\"raw\">\n_", type_of(f));
}

bool se3di_vtk_file_write(const se3di_vtk_file *f, const se3d_allocator *allocator,
                          const char *path)
{
    const char *ending = strrchr(path, '.');
    if (ending && strcmp(ending, ".vtkhdf") == 0) {
        return se3di_vtk_file_write_hdf5(f, allocator, path);
    }
    FILE *file = se3di_partial_open(path);
    if (!file) {
        return false;
    }
    put_head(file, f);
    for (size_t k = 0; k < f->array_count; ++k) {
        put_data(file, &f->arrays[k]);
    }
    fputs("\n</AppendedData>\n</VTKFile>\n", file);
    return se3di_partial_close(file, path);
}
