/* SPDX-License-Identifier: BSD-3-Clause */
/* What the calls of libse3d look like in memory: tables that tools/record_calls.py makes of the
 * public headers, and the walk over them that writes, reads and compares values. */
#ifndef SE3D_RECORD_LAYOUT_H
#define SE3D_RECORD_LAYOUT_H

#include "bytes.h"

#define LAYOUT_PARAMETERS_MAX 16

typedef enum layout_kind {
    LAYOUT_BYTES = 0,      /* numbers of `size` bytes */
    LAYOUT_TEXT = 1,       /* const char * */
    LAYOUT_CHARACTERS = 2, /* char[count], a text within a structure */
    LAYOUT_HANDLE = 3,     /* of an element of a system */
    LAYOUT_OWNER = 4,      /* pointer to an object */
    LAYOUT_STRUCT = 5,     /* `of` */
    LAYOUT_CALLBACK = 6,   /* `number` of layout_callbacks; its context is `partner` */
    LAYOUT_CONTEXT = 7,    /* of a callback, which has written it */
    LAYOUT_ALLOCATOR = 8   /* const se3d_allocator * */
} layout_kind;

typedef enum layout_way { LAYOUT_IN = 1, LAYOUT_OUT = 2, LAYOUT_BOTH = 3 } layout_way;

/* A number that follows from the other parameters of a call (`base` points to their addresses),
 * from the other members of a structure (`base` points to it), or from what was remembered. */
typedef struct layout_walk layout_walk;
typedef size_t (*layout_length)(const layout_walk *walk, const void *base);

typedef struct layout_struct layout_struct;

/* A parameter, a member, or a result. */
typedef struct layout_item {
    const char *name;
    layout_kind kind;
    layout_way way;          /* of parameters */
    int is_real;             /* they are of the type double */
    int pointer;             /* a pointer to such elements stands there, not they */
    size_t size;             /* of an element in bytes */
    size_t offset;           /* of a member */
    size_t count;            /* of elements, if there is no `length` */
    size_t number;           /* of the kind of object or callback */
    size_t partner;          /* index or offset of a callback's context */
    const layout_struct *of; /* of structures */
    layout_length length;    /* how many elements; of outputs, after the call */
    layout_length room;      /* of outputs, before the call; NULL: as `length` */
    layout_length stride;    /* bytes from one structure to the next, if the caller says so */
} layout_item;

struct layout_struct {
    const char *name;
    size_t size;
    int is_sized; /* it begins with its size */
    const layout_item *members;
    size_t member_count;
};

/* A public function, or a type of callback. */
typedef struct layout_function {
    const char *name;
    const layout_item *parameters;
    size_t parameter_count;
    const layout_item *result; /* NULL: void */
    int has_status;            /* the result is one: outputs are void if it is below zero */
    int destroys;              /* its first parameter */
    int is_concurrent;         /* a callback that several threads may call at a time */
    layout_length remembers;   /* the number of variables of what it made, NULL: none */
} layout_function;

extern const layout_struct layout_structs[];
extern const layout_function layout_functions[];
extern const size_t layout_function_count;
extern const layout_function layout_callbacks[];
extern const size_t layout_callback_count;
extern const char *const layout_owners[];
extern const size_t layout_owner_count;

/* Index of a function, layout_function_count: there is none of that name. */
size_t layout_find(const char *name);

/* What a walk needs of the recorder or the player. */
struct layout_walk {
    uint32_t (*name_owner)(layout_walk *walk, size_t kind, const void *object);
    uint32_t (*name_callback)(layout_walk *walk, const layout_item *item, const void *at,
                              const void *base);
    uint32_t (*name_allocator)(layout_walk *walk, const void *allocator);
    size_t (*recall)(const layout_walk *walk, const void *key, size_t size); /* variables of it */
    const void *definition; /* of the callback whose arguments are walked over */
    int is_whole;           /* outputs are written whole */
    int short_form;         /* else long arrays of numbers are written as their hash */
    int in_struct;          /* what is walked over is a member */
    int without_handles;    /* which differ from one run to the next */
};

size_t layout_times(size_t a, size_t b); /* SIZE_MAX if it is more */
size_t layout_at_most(size_t a, size_t b);
size_t layout_characters(const char *text, size_t size);
size_t layout_equations(const void *system, const void *constraint);
size_t layout_recall(const layout_walk *walk, const void *key, size_t size);
/* The n-th of the addresses of parameters. */
const void *layout_parameter(const void *base, size_t n);

/* The number of elements of an item, which stands at `at`. */
size_t layout_count(const layout_walk *walk, const layout_item *item, const void *base, int before);
/* The bytes from one of its elements to the next. */
size_t layout_stride(const layout_walk *walk, const layout_item *item, const void *base);
/* How much of a structure of `size` bytes is there for a member. */
int layout_has(const layout_struct *s, const layout_item *member, size_t size);
/* The size that a structure says it has; `stride` if it says none, or has no room for it. */
size_t layout_said(const layout_struct *s, const void *structure, size_t stride);

/* Write what stands at `at`. */
void layout_write(layout_walk *walk, const layout_item *item, const void *at, const void *base,
                  bytes *out);
/* Write the parameters of a call that go in, or come out of it. */
void layout_write_all(layout_walk *walk, const layout_function *f, void *const *arguments,
                      layout_way way, bytes *out);

#endif
