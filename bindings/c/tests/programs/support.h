/* What the test programs share: the plan, and checks that say what they found. */
#ifndef SUPPORT_H
#define SUPPORT_H

#include <scl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const int64_t FOREVER = -1, SECOND = 1000000000, MILLISECOND = 1000000;

/* The content of a file, which the caller frees. */
static inline char *read_file(const char *path, size_t *len) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        fprintf(stderr, "%s cannot be read\n", path);
        exit(2);
    }
    fseek(file, 0, SEEK_END);
    *len = (size_t)ftell(file);
    rewind(file);
    char *text = malloc(*len + 1);
    if (text == NULL || fread(text, 1, *len, file) != *len) {
        exit(2);
    }
    text[*len] = 0;
    fclose(file);
    return text;
}

/* Opens `program` with the plan of a file. */
static inline scl_status open_program(const char *path, const char *options, scl_component **component) {
    size_t len;
    char *plan = read_file(path, &len);
    scl_status status = scl_open(plan, len, "program", options, component);
    free(plan);
    return status;
}

/* Asserts a status, and that the text of an error contains some words. */
static inline void expect_at(int line, scl_status found, scl_status expected, const char *words) {
    if (found == expected && (found == SCL_OK || strstr(scl_error(), words) != NULL)) {
        return;
    }
    fprintf(stderr, "line %d: %s, not %s; expected `%s` in: %s\n", line, scl_status_name(found), scl_status_name(expected),
            words, scl_error());
    exit(1);
}

#define EXPECT(call, status, words) expect_at(__LINE__, (call), (status), (words))
#define OK(call) expect_at(__LINE__, (call), SCL_OK, "")
#define ASSERT(condition) \
    do { \
        if (!(condition)) { \
            fprintf(stderr, "line %d: not `%s`; last error: %s\n", __LINE__, #condition, scl_error()); \
            exit(1); \
        } \
    } while (0)

static inline void say(const char *text) {
    puts(text);
    fflush(stdout);
}

#endif
