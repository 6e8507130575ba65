/* Opens a component of `images.yaml` with a library without shared memory: `images PLAN_FILE COMPONENT`. The viewer prints
 * the number and the length of each frame. */
#include <inttypes.h>
#include <scl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv) {
    static char plan[1 << 20];
    FILE *file = argc == 3 ? fopen(argv[1], "r") : NULL;
    if (file == NULL) {
        printf("no plan\n");
        return 1;
    }
    size_t length = fread(plan, 1, sizeof plan, file);
    fclose(file);
    setvbuf(stdout, NULL, _IOLBF, BUFSIZ);

    scl_component *component;
    if (scl_open(plan, length, argv[2], NULL, &component) != SCL_OK) {
        printf("%s\n", scl_error());
        return 1;
    }
    printf("open\n");
    scl_gate *frames = scl_gate_by_name(component, "frames");
    if (strcmp(argv[2], "viewer") != 0) {
        getchar();
        return 0;
    }
    scl_message *message;
    while (scl_recv(frames, -1, &message) == SCL_OK) {
        size_t size = 0;
        const unsigned char *bytes = scl_message_data(message, &size);
        uint64_t number = 0;
        memcpy(&number, bytes, sizeof number);
        printf("%" PRIu64 " %zu\n", number, size);
        for (size_t index = 8; index < size; index++) {
            if (bytes[index] != (unsigned char)number) {
                printf("frame %" PRIu64 " is damaged\n", number);
                return 1;
            }
        }
        scl_message_free(message);
    }
    return 0;
}
