/* What the programs in C share: commands on standard input, answers on standard output, and the content of messages. */
#ifndef COMMON_H
#define COMMON_H

#include <inttypes.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Added by `right` to the number of a request, for its reply. */
#define REPLY 1000

/* The most words of a command, and the longest message. */
enum { WORDS = 4, LONGEST = 256 };

typedef struct {
    char line[LONGEST];
    const char *words[WORDS];
} command;

/* Reads the next command; false when the test has closed the input. */
static inline bool next_command(command *next) {
    if (fgets(next->line, sizeof next->line, stdin) == NULL) {
        return false;
    }
    char *rest = next->line;
    for (int word = 0; word < WORDS; word++) {
        char *found = strtok(rest, " \n");
        next->words[word] = found == NULL ? "" : found;
        rest = NULL;
    }
    return true;
}

static inline bool is(const command *given, int word, const char *text) {
    return strcmp(given->words[word], text) == 0;
}

static inline uint64_t number_of(const command *given, int word) { return strtoull(given->words[word], NULL, 10); }

/* Answers the test with a line. */
static inline void say(const char *text) {
    printf("%s\n", text);
    fflush(stdout);
}

/* Values in order of arrival, with consecutive ones merged: `0..10 12..13`. */
typedef struct {
    uint64_t from, to;
    bool first;
} ranges;

static inline ranges no_ranges(void) { return (ranges){.from = 0, .to = 0, .first = true}; }

static inline void print_range(ranges *found) {
    if (found->from < found->to) {
        printf("%s%" PRIu64 "..%" PRIu64, found->first ? "" : " ", found->from, found->to);
        found->first = false;
    }
}

static inline void add(ranges *found, uint64_t number) {
    if (found->from < found->to && number == found->to) {
        found->to++;
        return;
    }
    print_range(found);
    found->from = number;
    found->to = number + 1;
}

static inline void say_ranges(ranges *found) {
    print_range(found);
    say("");
}

/* The text of a message. */
static inline size_t text_of(uint64_t number, char text[LONGEST]) {
    return (size_t)snprintf(text, LONGEST, "sample %" PRIu64 " \xc3\xbc", number);
}

/* A message as canonical protobuf JSON, which has 64-bit numbers as strings. */
static inline size_t json_of(uint64_t number, char json[LONGEST]) {
    const char *format = "{\"number\":\"%" PRIu64 "\",\"text\":\"sample %" PRIu64 " \xc3\xbc\"}";
    return (size_t)snprintf(json, LONGEST, format, number, number);
}

/* The number in a text, or in the JSON of a message, whatever its white space. False if it is neither. */
static inline bool number_in(const void *data, size_t size, uint64_t *number) {
    char copy[LONGEST], expected[LONGEST];
    if (size >= sizeof copy) {
        return false;
    }
    memcpy(copy, data, size);
    copy[size] = 0;
    const char *text = strstr(copy, "sample ");
    if (text == NULL || sscanf(text, "sample %" SCNu64, number) != 1) {
        return false;
    }
    text_of(*number, expected);
    if (text == copy) {
        return strcmp(copy, expected) == 0;
    }
    snprintf(expected, sizeof expected, "\"%" PRIu64 "\"", *number);
    // Canonical JSON may leave out a number that is 0.
    return *number == 0 || (strstr(copy, "\"number\"") != NULL && strstr(copy, expected) != NULL);
}

#endif
