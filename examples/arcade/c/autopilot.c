/* The autopilot: opens its gates and its state file, and works in the beat of the inertial unit. */
#include "autopilot.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 1024, NAME_SIZE = 256 };

/*
 * In the runtime folder of SCL, which belongs to this user alone and is in memory on most systems. Another vehicle, which
 * runs under another name of the system, has a file of its own.
 */
static bool state_path(char path[PATH_SIZE]) {
    const char *runtime = getenv("SCL_RUNTIME_DIR"), *session = getenv("XDG_RUNTIME_DIR");
    const char *temporary = getenv("TMPDIR"), *system = getenv("SCL_SYSTEM");
    char name[NAME_SIZE];
    int length = snprintf(name, NAME_SIZE, "%s-autopilot.state", system != NULL && *system != '\0' ? system : "arcade");
    if (length >= NAME_SIZE) {
        return false;
    }
    if (runtime != NULL && *runtime != '\0') {
        length = snprintf(path, PATH_SIZE, "%s/%s", runtime, name);
    } else if (session != NULL && *session != '\0') {
        length = snprintf(path, PATH_SIZE, "%s/scl/%s", session, name);
    } else {
        const char *folder = temporary != NULL && *temporary != '\0' ? temporary : "/tmp";
        length = snprintf(path, PATH_SIZE, "%s/scl-%u/%s", folder, (unsigned)getuid(), name);
    }
    return length < PATH_SIZE;
}

/* Without the file the autopilot flies, but cannot go on after a crash. */
static void open_state(resume *state) {
    char path[PATH_SIZE];
    *state = (resume){0};
    if (!state_path(path)) {
        fprintf(stderr, "warning: no state for a restart in the air: the path of the runtime folder is too long\n");
    } else if (!resume_open(state, path, sizeof(flight_controller))) {
        fprintf(stderr, "warning: no state for a restart in the air: %s: %s\n", path, strerror(errno));
    }
}

int main(int count, char **arguments) {
    setlinebuf(stdout);
    if (count > 1) {
        fprintf(stderr, "error: unexpected argument `%s`\nusage: autopilot\n", arguments[1]);
        return 2;
    }
    static autopilot self;
    scl_status status = arcade_autopilot_open(&self.gates, NULL);
    if (status == SCL_OK) {
        open_state(&self.state); /* after opening, so that no second autopilot writes it */
        autopilot_begin(&self);
        while (status == SCL_OK) {
            status = autopilot_turn(&self);
        }
        resume_close(&self.state);
    }
    if (status != SCL_STOPPED) {
        fprintf(stderr, "error: %s\n", scl_error());
        return 1;
    }
    arcade_autopilot_close(&self.gates, 1000000000);
    return 0;
}
