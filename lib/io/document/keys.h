/* SPDX-License-Identifier: BSD-3-Clause */
/* The keys of the model file. Every object of it has one table, by which its keys are checked and
 * read, and from which docs/se3d.schema.json and the tables of docs/model-file/reference.md are
 * written (tools/update_keys.sh). A new key is a row. */
#ifndef SE3D_IO_KEYS_H
#define SE3D_IO_KEYS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What may stand under a key. */
typedef enum se3di_kind {
    /* These may have a place in a structure: */
    SE3DI_KIND_NUMBER = 0,      /* double; an expression over the parameters */
    SE3DI_KIND_VECTOR = 1,      /* double[3] */
    SE3DI_KIND_DIRECTION = 2,   /* double[3], not zero */
    SE3DI_KIND_ORIENTATION = 3, /* double[4]: Euler parameters */
    SE3DI_KIND_BOOL = 4,        /* int32_t */
    SE3DI_KIND_WORD = 5,        /* int32_t: the index among `words` */
    SE3DI_KIND_TEXT = 6,        /* const char * */
    SE3DI_KIND_NAME = 7,        /* const char *; what others refer to */
    SE3DI_KIND_PLACES = 8,      /* how many; functions read the others: */
    SE3DI_KIND_COUNT = 9,       /* a whole number from 0 to `most`; double */
    SE3DI_KIND_TYPE,            /* one of the object's types */
    SE3DI_KIND_TITLE,
    SE3DI_KIND_VERSION,
    SE3DI_KIND_PARAMETERS,
    SE3DI_KIND_NAMED_POINTS,
    SE3DI_KIND_CONDITION,   /* true, false, or an expression */
    SE3DI_KIND_PARTS,       /* names and objects */
    SE3DI_KIND_VALUES,      /* names and numbers or vectors */
    SE3DI_KIND_FILE,        /* ends with one of `words`, if there are some */
    SE3DI_KIND_BODY,        /* the name of one, also of the ground */
    SE3DI_KIND_JOINT,       /* the name of one */
    SE3DI_KIND_MATERIAL,    /* the name of one */
    SE3DI_KIND_POINT,       /* of a body: 3 numbers, or the name of a marker */
    SE3DI_KIND_FUNCTION,    /* a number, an expression or a spline */
    SE3DI_KIND_FUNCTIONS,   /* 3 of them */
    SE3DI_KIND_COEFFICIENT, /* a number or a spline */
    SE3DI_KIND_MATRIX3,
    SE3DI_KIND_MATRIX6, /* a diagonal or six rows */
    SE3DI_KIND_EULER_PARAMETERS,
    SE3DI_KIND_INERTIA,
    SE3DI_KIND_RADIUS,
    SE3DI_KIND_BOUNDARY, /* 3 of `words` */
    SE3DI_KIND_CURVE,    /* a list of two pairs of numbers or more, or the name of a file */
    SE3DI_KIND_TEXTS,    /* a list of two texts */
    SE3DI_KIND_PAIRS,    /* a list of one pair of numbers or more */
    SE3DI_KIND_VECTORS,  /* a list of three vectors or more */
    SE3DI_KIND_NUMBERS,  /* a list of one number or more */
    SE3DI_KIND_HEIGHTS,  /* a list of two rows of numbers or more, or an expression */
    SE3DI_KIND_NAMES,    /* a list of one name or more */
    SE3DI_KIND_ROWS,     /* a list of two rows or more, each of two numbers or more */
    SE3DI_KIND_COLOR,    /* 3 numbers or 4 */
    SE3DI_KIND_CHANNELS,
    SE3DI_KIND_SNAPSHOTS, /* true, or the name of a set */
    SE3DI_KIND_OBJECT,    /* an `object` */
    SE3DI_KIND_LIST,      /* of objects */
    SE3DI_KIND_ONE_OR_LIST,
    SE3DI_KIND_TERMS,    /* a list of 1 to 4 objects */
    SE3DI_KIND_VARIED,   /* names and texts, lists of numbers or objects */
    SE3DI_KIND_MEASURES, /* names and texts or objects */
    SE3DI_KIND_END
} se3di_kind;

typedef enum se3di_range {
    SE3DI_ANY = 0,          /* finite */
    SE3DI_POSITIVE = 1,     /* finite and > 0 */
    SE3DI_NOT_NEGATIVE = 2, /* finite and >= 0 */
    SE3DI_RESTITUTION = 3   /* 0.01 to 1 */
} se3di_range;

typedef struct se3di_key {
    const char *key;
    se3di_kind kind;
    se3di_range range;
    const char *structure; /* where it goes: name of the structure, NULL: a function reads it */
    size_t offset, size;   /* of the member in it */
    double most;           /* of a COUNT: the largest */
    const char *types;     /* that have it, a space at each end; NULL: all */
    const char *(*name_of)(int32_t); /* words of the core, "" behind the last; NULL: none */
    const char *const *words;        /* then these, NULL at the end; NULL: none */
    const char *object;              /* its name */
    bool required;
    const char *standard; /* what holds without it; NULL: nothing worth a word */
    const char *text;     /* one sentence, with units and frame */
} se3di_key;

/* The place that a key goes to. */
#define SE3DI_INTO(type, member)                                                                   \
    .structure = #type, .offset = offsetof(type, member), .size = sizeof(((type *)0)->member)

typedef struct se3di_object {
    const char *name; /* as in the schema's $defs */
    const char *text;
    const se3di_key *keys; /* key NULL at the end; a key may have several rows of different types */
    const char *const *types; /* NULL: it has none; NULL at the end */
    const char *rule;         /* NULL, or what else the schema says: members of a JSON object */
} se3di_object;

/* True if `word` is one of the space-separated words of `list` (a space at each end). */
bool se3di_keys_contain(const char *list, const char *word);
/* Whether things of this type have what the row says; type NULL: of any type. */
bool se3di_key_is_of(const se3di_key *key, const char *type);
/* The row of a key, NULL if there is none; type NULL: of any type. */
const se3di_key *se3di_object_find(const se3di_object *object, const char *type, const char *key);
enum { SE3DI_WORDS_MAX = 32 };
/* List the words of a row, with a NULL behind the last. */
void se3di_key_list_words(const se3di_key *key, const char *words[SE3DI_WORDS_MAX + 1]);
/* Write the keys of a type (NULL: all), `separator` between them, cut to `size` bytes. */
void se3di_object_list(const se3di_object *object, const char *type, const char *separator,
                       char *text, size_t size);

/* kinds.c: "> 0" and the like, "" if all finite numbers may stand there. */
const char *se3di_range_get_text(se3di_range range);
/* Write what may stand under a key, "number > 0" or "`one`, `other`", as Markdown. */
void se3di_key_describe(const se3di_object *object, const se3di_key *row, char *text, size_t size);

#endif
