/* The GPS receiver: measures the simulated world, and publishes five fixes a second. */
#include "arcade_scl.h"
#include "parameter_table.h"
#include "receiver.h"

#include <getopt.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static const int64_t SILENCE = 1000000000; /* nanoseconds without the world until it is reported */

static const parameter TABLE[] = {
    {"gps.rate", offsetof(receiver_parameters, rate), 5.0},
    {"home.latitude", offsetof(receiver_parameters, home.latitude), 50.6866},
    {"home.longitude", offsetof(receiver_parameters, home.longitude), 10.9190},
    {"home.altitude", offsetof(receiver_parameters, home.altitude), 480.0},
};
static const size_t TABLE_LENGTH = sizeof TABLE / sizeof *TABLE;

typedef struct options {
    uint64_t seed;
    outage outage;
} options;

static const char USAGE[] = "usage: gps_sensor [--seed NUMBER] [--outage FROM:UNTIL]\n"
                            "  --seed NUMBER          seed of the noise (default 1)\n"
                            "  --outage FROM:UNTIL    no reception from FROM to UNTIL, in s of the vehicle's clock\n";

static bool read_seed(const char *text, uint64_t *seed) {
    char rest;
    unsigned long long number;
    if (text[0] == '-' || sscanf(text, "%llu%c", &number, &rest) != 1) {
        fprintf(stderr, "error: --seed `%s` is not a whole number\n", text);
        return false;
    }
    *seed = number;
    return true;
}

static bool read_outage(const char *text, outage *outage) {
    char rest;
    if (sscanf(text, "%lf:%lf%c", &outage->from, &outage->until, &rest) != 2 || !(outage->from < outage->until)) {
        fprintf(stderr, "error: --outage `%s` is not two ascending times such as 20:25\n", text);
        return false;
    }
    return true;
}

static bool read_options(int count, char **arguments, options *options) {
    static const struct option known[] = {
        {"seed", required_argument, NULL, 's'}, {"outage", required_argument, NULL, 'o'}, {NULL, 0, NULL, 0}};
    *options = (struct options){.seed = 1};
    for (int found; (found = getopt_long(count, arguments, "", known, NULL)) != -1;) {
        bool good = found == 's'   ? read_seed(optarg, &options->seed)
                    : found == 'o' ? read_outage(optarg, &options->outage)
                                   : false;
        if (!good) {
            return false;
        }
    }
    if (optind < count) {
        fprintf(stderr, "error: unexpected argument `%s`\n", arguments[optind]);
    }
    return optind == count;
}

/* One line when reception begins and ends. */
static void report(Arcade__FixQuality *last, const Arcade__Fix *fix) {
    if (fix->quality != *last && fix->quality == ARCADE__FIX_QUALITY__FIX_QUALITY_3D) {
        printf("3D fix: %u satellites\n", fix->satellites);
    } else if (fix->quality != *last) {
        printf("fix lost: %u satellites\n", fix->satellites);
    }
    *last = fix->quality;
}

static void read_parameters(arcade_gps_sensor *gates, receiver_parameters *parameters) {
    Arcade__Parameters *message;
    if (arcade_gps_sensor_parameters_latest(gates, &message) == SCL_OK) {
        parameter_table_read(TABLE, TABLE_LENGTH, message, parameters);
        arcade_gps_sensor_parameters_free(message);
    }
}

static scl_status run(arcade_gps_sensor *gates, options options) {
    receiver receiver = receiver_new(options.seed, options.outage);
    receiver_parameters parameters;
    Arcade__FixQuality quality = ARCADE__FIX_QUALITY__FIX_QUALITY_NONE;
    Arcade__World *world;
    Arcade__Fix fix;
    bool silent = false;
    parameter_table_set_defaults(TABLE, TABLE_LENGTH, &parameters);
    while (true) {
        scl_status status = arcade_gps_sensor_world_recv(gates, &world, SILENCE);
        if (status == SCL_TIMEOUT) {
            if (!silent) {
                printf("fix lost: %s\n", scl_error());
            }
            silent = true;
            quality = ARCADE__FIX_QUALITY__FIX_QUALITY_NONE;
            continue;
        }
        if (status != SCL_OK) {
            return status;
        }
        silent = false;
        read_parameters(gates, &parameters);
        bool due = receiver_measure(&receiver, &parameters, world, &fix);
        arcade_gps_sensor_world_free(world);
        if (due) {
            report(&quality, &fix);
            status = arcade_gps_sensor_fix_send(gates, &fix, -1);
        }
        if (status != SCL_OK) {
            return status;
        }
    }
}

int main(int count, char **arguments) {
    setlinebuf(stdout);
    options options;
    if (!read_options(count, arguments, &options)) {
        fputs(USAGE, stderr);
        return 2;
    }
    arcade_gps_sensor gates;
    scl_status status = arcade_gps_sensor_open(&gates, NULL);
    if (status == SCL_OK) {
        printf("searching for satellites, noise of seed %" PRIu64 "\n", options.seed);
        status = run(&gates, options);
    }
    if (status != SCL_STOPPED) {
        fprintf(stderr, "error: %s\n", scl_error());
        return 1;
    }
    arcade_gps_sensor_close(&gates, 1000000000);
    return 0;
}
