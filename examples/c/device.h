// A Vulkan device of the host's own that selvedge can draw on.

#ifndef HOST_DEVICE_H
#define HOST_DEVICE_H

#include <stdio.h>

#include <vulkan/vulkan.h>

#include <selvedge.h>

#define FORMAT VK_FORMAT_R8G8B8A8_UNORM

// Each prints a failed call and returns 1; the caller frees the objects that exist by then.
#define VK(call)                                                                     \
    do {                                                                             \
        VkResult result = (call);                                                    \
        if (result != VK_SUCCESS) {                                                  \
            return fprintf(stderr, "%s: VkResult %d\n", #call, (int)result), 1;      \
        }                                                                            \
    } while (0)
#define SELVEDGE(call)                                                               \
    do {                                                                             \
        if ((call) != SELVEDGE_STATUS_OK) {                                          \
            return fprintf(stderr, "%s: %s\n", #call, selvedge_last_error()), 1;     \
        }                                                                            \
    } while (0)

typedef struct {
    VkInstance instance;
    VkPhysicalDevice physical;
    uint32_t family;
    VkDevice device;
    VkQueue queue;
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkFence fence;
} Device;

// What selvedge gets on loan.
static SelvedgeVulkan lent(const Device* d)
{
    return (SelvedgeVulkan){
        .struct_size = sizeof(SelvedgeVulkan),
        .get_instance_proc_addr = (SelvedgeGetInstanceProcAddr)vkGetInstanceProcAddr,
        .instance = d->instance,
        .physical_device = d->physical,
        .device = d->device,
        .queue_family = d->family,
        .slots = 1,
        .colour_format = FORMAT,
    };
}

// The first physical device that lacks nothing.
static int choose(Device* d)
{
    VkPhysicalDevice all[16];
    uint32_t count = 16;
    const VkResult found = vkEnumeratePhysicalDevices(d->instance, &count, all);
    if (found != VK_SUCCESS && found != VK_INCOMPLETE) {
        return 1;
    }
    for (uint32_t i = 0; i < count; ++i) {
        d->physical = all[i];
        const SelvedgeVulkan vulkan = lent(d);
        if (selvedge_vulkan_missing(&vulkan) != SELVEDGE_STATUS_OK) {
            fprintf(stderr, "device %u: %s\n", i, selvedge_last_error());
            continue;
        }
        VkQueueFamilyProperties families[16];
        uint32_t family_count = 16;
        vkGetPhysicalDeviceQueueFamilyProperties(d->physical, &family_count, families);
        const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
        for (d->family = 0; d->family < family_count; ++d->family) {
            if ((families[d->family].queueFlags & wanted) == wanted) {
                return 0;
            }
        }
    }
    fprintf(stderr, "no device suffices\n");
    return 1;
}

static int make_device(Device* d)
{
    const VkApplicationInfo app = { .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3 };
    const VkInstanceCreateInfo instance = { .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &app };
    VK(vkCreateInstance(&instance, NULL, &d->instance));
    if (choose(d) != 0) {
        return 1;
    }
    // a host sets the features that it needs itself in these structs, too
    VkPhysicalDeviceFeatures core = { 0 };
    VkPhysicalDeviceVulkan13Features v13 = { .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES };
    VkPhysicalDeviceVulkan12Features v12 = { .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES };
    SELVEDGE(selvedge_vulkan_features(&core, &v12, &v13));
    v12.pNext = &v13;
    const VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = d->family,
        .queueCount = 1,
        .pQueuePriorities = &(const float){ 1.0f },
    };
    const VkDeviceCreateInfo device = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &v12,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .enabledExtensionCount = 1,
        .ppEnabledExtensionNames = (const char*[]){ VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME },
        .pEnabledFeatures = &core,
    };
    VK(vkCreateDevice(d->physical, &device, NULL, &d->device));
    vkGetDeviceQueue(d->device, d->family, 0, &d->queue);
    return 0;
}

#endif
