/* Two copies of the library in one process: `copies PLAN_FILE LIBRARY OTHER_LIBRARY`. */
#include "support.h"

#include <dlfcn.h>

/* The functions of one copy. */
struct copy {
    scl_status (*open)(const char *, size_t, const char *, const char *, scl_component **);
    scl_status (*ready)(scl_component *, int64_t);
    scl_status (*close)(scl_component *, int64_t);
    const char *(*error)(void);
};

static void *loaded(void *library, const char *function) {
    void *found = library == NULL ? NULL : dlsym(library, function);
    if (found == NULL) {
        fprintf(stderr, "%s\n", dlerror());
        exit(2);
    }
    return found;
}

static struct copy load(const char *path) {
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    struct copy copy;
    *(void **)&copy.open = loaded(library, "scl_open");
    *(void **)&copy.ready = loaded(library, "scl_ready");
    *(void **)&copy.close = loaded(library, "scl_close");
    *(void **)&copy.error = loaded(library, "scl_error");
    return copy;
}

int main(int count, char **arguments) {
    size_t len;
    char line[8];
    scl_component *first, *second, *peer;
    char *plan = read_file(arguments[1], &len);
    struct copy one = load(arguments[2]), other = load(arguments[count - 1]);
    ASSERT(one.open != other.open);
    OK(one.open(plan, len, "program", NULL, &first));
    for (int attempt = 0; attempt < 3; attempt++) {
        ASSERT(other.open(plan, len, "program", NULL, &second) == SCL_TAKEN);
        ASSERT(strstr(other.error(), "`program`") != NULL);
    }
    /* A peer in the other copy looks whether `program` runs. */
    OK(other.open(plan, len, "peer", NULL, &peer));
    OK(other.ready(peer, FOREVER));
    say("open");
    if (fgets(line, sizeof line, stdin) == NULL) {
        return 1;
    }
    OK(other.close(peer, FOREVER));
    OK(one.close(first, FOREVER));
    OK(other.open(plan, len, "program", NULL, &second));
    ASSERT(one.open(plan, len, "program", NULL, &first) == SCL_TAKEN);
    OK(other.close(second, FOREVER));
    free(plan);
    say("closed");
    return 0;
}
