/* Reads the parameters of the component `program`. The environment has SCL_SET=program.gain=1.5,program.pin=7. */
#include "support.h"

static char *plan;
static size_t plan_len;
static scl_component *component, *peer;

static int64_t signed_of(const char *name) {
    int64_t value = 0;
    OK(scl_parameter_i64(component, name, 0, &value));
    return value;
}

static uint64_t unsigned_of(const char *name) {
    uint64_t value = 0;
    OK(scl_parameter_u64(component, name, 0, &value));
    return value;
}

static double number_of(const char *name, size_t index) {
    double value = 0;
    OK(scl_parameter_f64(component, name, index, &value));
    return value;
}

static uint64_t duration_of(const char *name) {
    uint64_t value = 0;
    OK(scl_parameter_duration_ns(component, name, 0, &value));
    return value;
}

static bool text_is(const char *name, size_t index, const char *expected) {
    const char *value = NULL;
    OK(scl_parameter_text(component, name, index, &value));
    return strcmp(value, expected) == 0;
}

static size_t count_of(const char *name) {
    size_t count = 100;
    OK(scl_parameter_count(component, name, &count));
    return count;
}

static void every_type_has_its_call(void) {
    ASSERT(signed_of("tiny") == INT8_MIN && signed_of("small") == INT16_MIN && signed_of("medium") == INT32_MIN);
    ASSERT(signed_of("lowest") == INT64_MIN && signed_of("color") == UINT32_MAX);
    ASSERT(unsigned_of("pin") == UINT8_MAX && unsigned_of("port") == UINT16_MAX && unsigned_of("color") == UINT32_MAX);
    ASSERT(unsigned_of("largest") == UINT64_MAX);
    ASSERT(number_of("ratio", 0) == 0.5 && number_of("gain", 0) == 0.8);
    ASSERT(duration_of("period") == 10000000 && duration_of("delays") == 1000000000);
    ASSERT(text_is("label", 0, "vorn, links") && text_is("mode", 0, "auto"));
    bool enabled = false;
    OK(scl_parameter_bool(component, "enabled", 0, &enabled));
    ASSERT(enabled);
    ASSERT(count_of("offsets") == 2 && number_of("offsets", 0) == 0 && number_of("offsets", 1) == -0.5);
    ASSERT(count_of("names") == 2 && text_is("names", 0, "a") && text_is("names", 1, "b, c"));
    ASSERT(count_of("flags") == 0 && count_of("gain") == 1);
}

/* What generated code does. */
static void items_are_arrays(void) {
    const void *items;
    size_t count;
    OK(scl_parameter_items(component, "offsets", "f64", &items, &count));
    ASSERT(count == 2 && ((const double *)items)[1] == -0.5);
    OK(scl_parameter_items(component, "names", "text", &items, &count));
    ASSERT(count == 2 && strcmp(((const char *const *)items)[1], "b, c") == 0);
    OK(scl_parameter_items(component, "small", "i16", &items, &count));
    ASSERT(count == 1 && *(const int16_t *)items == INT16_MIN);
    OK(scl_parameter_items(component, "ratio", "f32", &items, &count));
    ASSERT(count == 1 && *(const float *)items == 0.5f);
    OK(scl_parameter_items(component, "mode", "text", &items, &count));
    ASSERT(count == 1 && strcmp(*(const char *const *)items, "auto") == 0);
    OK(scl_parameter_items(component, "flags", "bool", &items, &count));
    ASSERT(count == 0 && items != NULL);
    EXPECT(scl_parameter_items(component, "gain", "f32", &items, &count), SCL_KIND,
           "parameter `program.gain` (f64) is not of the type f32");
    ASSERT(count == 0 && items == NULL);
}

static void wrong_calls_are_explained(void) {
    double number;
    int64_t whole;
    uint64_t positive;
    bool flag;
    const char *text;
    size_t count;
    EXPECT(scl_parameter_f64(component, "gian", 0, &number), SCL_NAME,
           "component `program` has no parameter `gian`; did you mean `gain`?");
    EXPECT(scl_parameter_count(component, "gian", &count), SCL_NAME, "did you mean `gain`?");
    EXPECT(scl_parameter_i64(component, "gain", 0, &whole), SCL_KIND,
           "parameter `program.gain` (f64) is not a whole number that an int64_t holds");
    EXPECT(scl_parameter_i64(component, "largest", 0, &whole), SCL_KIND, "(u64) is not a whole number");
    EXPECT(scl_parameter_u64(component, "tiny", 0, &positive), SCL_KIND, "(i8) is not a whole number");
    EXPECT(scl_parameter_duration_ns(component, "largest", 0, &positive), SCL_KIND, "(u64) is not a duration");
    EXPECT(scl_parameter_bool(component, "mode", 0, &flag), SCL_KIND, "(one of `manual` and `auto`) is not a bool");
    EXPECT(scl_parameter_text(component, "offsets", 0, &text), SCL_KIND, "(list of 2 f64) is not a text");
    EXPECT(scl_parameter_f64(component, "offsets", 2, &number), SCL_ARGUMENT,
           "`index` is 2, but parameter `program.offsets` has the count 2");
    EXPECT(scl_parameter_bool(component, "flags", 0, &flag), SCL_ARGUMENT, "has the count 0");
    EXPECT(scl_parameter_f64(component, NULL, 0, &number), SCL_ARGUMENT, "`name` is NULL");
    EXPECT(scl_parameter_f64(component, "gain", 0, NULL), SCL_ARGUMENT, "`value` is NULL");
    EXPECT(scl_parameter_f64(NULL, "gain", 0, &number), SCL_ARGUMENT, "the component is NULL");
    EXPECT(scl_parameter_f64(peer, "gain", 0, &number), SCL_NAME, "has no parameter `gain`");
}

static void live_parameters_are_taken_over(void) {
    bool changed = true;
    OK(scl_update_parameters(component, 0, &changed));
    ASSERT(!changed);
    OK(scl_set_parameter(component, "gain", "1.25"));
    OK(scl_set_parameter(component, "label", "hinten"));
    ASSERT(number_of("gain", 0) == 0.8 && text_is("label", 0, "vorn, links"));
    /* What has changed before is not waited for. */
    OK(scl_update_parameters(component, -1, &changed));
    ASSERT(changed && number_of("gain", 0) == 1.25 && text_is("label", 0, "hinten"));
    OK(scl_update_parameters(component, 0, &changed));
    ASSERT(!changed && number_of("gain", 0) == 1.25);
    OK(scl_update_parameters(component, 1000, &changed));
    ASSERT(!changed);
    EXPECT(scl_set_parameter(component, "gian", "1"), SCL_NAME, "no parameter `gian`; did you mean `gain`?");
    EXPECT(scl_set_parameter(component, "pin", "1"), SCL_ARGUMENT, "is fixed while its program runs");
    EXPECT(scl_set_parameter(component, "gain", "fast"), SCL_ARGUMENT, "expected a finite number, found `fast`");
    EXPECT(scl_set_parameter(component, NULL, "1"), SCL_ARGUMENT, "`name`");
    EXPECT(scl_set_parameter(component, "gain", NULL), SCL_ARGUMENT, "`value`");
    EXPECT(scl_update_parameters(component, 0, NULL), SCL_ARGUMENT, "`changed`");
    ASSERT(number_of("gain", 0) == 1.25);
}

static void values_are_set_when_a_component_is_opened(const char *path) {
    OK(open_program(path, "{\"set\": {\"program.gain\": \"2.5\", \"program.names\": \"[]\"}}", &component));
    ASSERT(number_of("gain", 0) == 2.5 && unsigned_of("pin") == 7 && count_of("names") == 0);
    OK(scl_close(component, 0));
    EXPECT(open_program(path, "{\"set\": {\"program.gain\": \"fast\"}}", &component), SCL_ENVIRONMENT,
           "parameter `program.gain` cannot have the value that it is set to: expected a finite number, found `fast`");
    EXPECT(open_program(path, "{\"set\": {\"program.gian\": \"1\"}}", &component), SCL_ENVIRONMENT,
           "has no parameter `gian`, which is set; did you mean `gain`?");
    EXPECT(open_program(path, "{\"set\": {\"gain\": \"1\"}}", &component), SCL_ENVIRONMENT,
           "expected `component.parameter=value`");
    EXPECT(open_program(path, "{\"set\": {\"program.gain\": 1}}", &component), SCL_ARGUMENT, "`options_json`");
}

int main(int count, char **arguments) {
    if (count != 2) {
        return 2;
    }
    plan = read_file(arguments[1], &plan_len);
    OK(scl_open_test(plan, plan_len, "program", &component, &peer));
    every_type_has_its_call();
    items_are_arrays();
    wrong_calls_are_explained();
    live_parameters_are_taken_over();
    OK(scl_close(component, 0));
    double number;
    bool changed = true;
    EXPECT(scl_update_parameters(component, 0, &changed), SCL_HANDLE, "it was closed");
    ASSERT(!changed);
    EXPECT(scl_parameter_f64(component, "gain", 0, &number), SCL_HANDLE, "it was closed");
    OK(scl_close(peer, 0));

    const char *options = "{\"set\": {\"program.gain\": \"0.25\"}}";
    OK(scl_open_test_with(plan, plan_len, "program", options, &component, &peer));
    ASSERT(number_of("gain", 0) == 0.25 && unsigned_of("pin") == UINT8_MAX);
    OK(scl_close(component, 0));
    OK(scl_close(peer, 0));
    EXPECT(scl_open_test_with(plan, plan_len, "program", "{\"set\": 1}", &component, &peer), SCL_ARGUMENT, "expected a map");

    values_are_set_when_a_component_is_opened(arguments[1]);
    free(plan);
    say("done");
    return 0;
}
