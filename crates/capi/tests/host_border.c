// Calls with null pointers, null handles and wrong sizes return a status and a sentence, and do not crash. No device is
// made.

#include "check.h"

static void nothing(void) { }

static void (*no_function(void* instance, const char* name))(void)
{
    (void)instance;
    (void)name;
    return nothing;
}

int main(void)
{
    SelvedgeHost* host = (SelvedgeHost*)1;
    SelvedgeVulkan vulkan = { .struct_size = sizeof vulkan };
    WANT(ARGUMENT, selvedge_host_new(&vulkan, &host), "get_instance_proc_addr is null");
    HOLDS(host == NULL);
    WANT(ARGUMENT, selvedge_vulkan_missing(&vulkan), "get_instance_proc_addr is null");
    vulkan.get_instance_proc_addr = no_function;
    WANT(ARGUMENT, selvedge_vulkan_missing(&vulkan), "null handle");
    WANT(ARGUMENT, selvedge_host_new(&vulkan, NULL), "null pointer");
    WANT(ARGUMENT, selvedge_host_new(NULL, &host), "get_instance_proc_addr is null");
    vulkan.struct_size = 3;
    WANT(ARGUMENT, selvedge_host_new(&vulkan, &host), "struct_size");
    char features[4096] = { 0 };
    WANT(ARGUMENT, selvedge_vulkan_features(NULL, features, features), "null pointer");
    WANT(ARGUMENT, selvedge_vulkan_features(features, features, NULL), "null pointer");

    SelvedgeView view = { .struct_size = sizeof view, .width = 8, .height = 8 };
    SelvedgeTargets targets = { .struct_size = sizeof targets };
    SelvedgeReport report = { .struct_size = sizeof report };
    const double columns[12] = { 0 };
    WANT(ARGUMENT, selvedge_host_upload(NULL, NULL, &view), "host is a null pointer");
    WANT(ARGUMENT, selvedge_host_record(NULL, features, 0, &view, &targets), "host is a null pointer");
    WANT(ARGUMENT, selvedge_host_report(NULL, 0, &report), "host is a null pointer");
    WANT(ARGUMENT, selvedge_host_set_transform(NULL, 0, columns), "host is a null pointer");
    WANT(ARGUMENT, selvedge_host_set_visible(NULL, 0, 1), "host is a null pointer");
    const float colour[4] = { 0 };
    WANT(ARGUMENT, selvedge_host_set_colour(NULL, 0, colour), "host is a null pointer");
    WANT(ARGUMENT, selvedge_host_set_selected(NULL, 0, colour), "host is a null pointer");
    uint64_t number = 0;
    WANT(ARGUMENT, selvedge_host_add(NULL, NULL, &number), "host is a null pointer");
    WANT(ARGUMENT, selvedge_host_remove(NULL, 1), "host is a null pointer");
    WANT(ARGUMENT, selvedge_host_instances(NULL, 1, &number, &number), "host is a null pointer");
    SelvedgeHit hit = { .struct_size = sizeof hit };
    WANT(ARGUMENT, selvedge_host_pick(NULL, 0, 0), "host is a null pointer");
    WANT(ARGUMENT, selvedge_host_picked(NULL, 0, &hit), "host is a null pointer");
    WANT(ARGUMENT, selvedge_host_discard(NULL, 0), "host is a null pointer");
    WANT(ARGUMENT, selvedge_host_device_lost(NULL), "host is a null pointer");
    selvedge_host_free(NULL);
    return 0;
}
