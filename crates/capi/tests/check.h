// What the tests in C share: their checks, and a model.

#ifndef SELVEDGE_TESTS_CHECK_H
#define SELVEDGE_TESTS_CHECK_H

#include <stdio.h>
#include <string.h>

#include <selvedge.h>

// Each prints what is wrong, with its line, and returns 1.
#define WANT(status, call, words)                                                                             \
    do {                                                                                                      \
        SelvedgeStatus got = (call);                                                                          \
        const char* said = selvedge_last_error();                                                             \
        if (got != (status) || strstr(said, (words)) == NULL || ((status) == SELVEDGE_STATUS_OK) != !*said) { \
            return fprintf(stderr, "line %d: status %d: \"%s\"\n", __LINE__, (int)got, said), 1;              \
        }                                                                                                     \
    } while (0)
#define HOLDS(what)                                                                                           \
    do {                                                                                                      \
        if (!(what)) {                                                                                        \
            return fprintf(stderr, "line %d: %s\n", __LINE__, #what), 1;                                      \
        }                                                                                                     \
    } while (0)

#define OK SELVEDGE_STATUS_OK
#define ARGUMENT SELVEDGE_STATUS_ARGUMENT
#define FILE_ERROR SELVEDGE_STATUS_FILE
#define RENDER SELVEDGE_STATUS_RENDER

// A block of 2 x 3 x 5 mm, a corner of which is the origin.
static const char BLOCK[] = "v 0 0 0\nv 0 0 5\nv 0 3 0\nv 0 3 5\nv 2 0 0\nv 2 0 5\nv 2 3 0\nv 2 3 5\n"
                            "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";

#endif
