/*
 * What survives a crash: a memory-mapped file with two copies of a state. A process that is killed while it writes one
 * copy leaves the other; sequence number and checksum tell which copy is the newest complete one.
 */
#ifndef RESUME_H
#define RESUME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct resume {
    unsigned char *memory; /* NULL if the file cannot be used */
    size_t size;           /* of the state, in bytes */
    uint64_t sequence;     /* of the newest copy; 0 if there is none */
} resume;

/*
 * Opens or creates the file at `path` for states of `size` bytes. Without the file, for example on a read-only disk, it
 * returns false and sets errno; the others of these functions then do nothing.
 */
bool resume_open(resume *self, const char *path, size_t size);

/* Stores the newest complete copy in `state`. Returns false if there is none. */
bool resume_load(resume *self, void *state);

/* Replaces the older copy. The operating system keeps it if this process dies; it is not forced to the disk. */
void resume_store(resume *self, const void *state);

void resume_close(resume *self);

#endif
