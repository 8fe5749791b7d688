// A host with a Vulkan device of its own: selvedge records into the host's command buffer, over the host's picture.
//
//     cc -std=c11 host.c $(pkg-config --cflags --libs selvedge) -lvulkan -o host
//     ./host part.step 640 480
//
// The host clears its image to blue, records the model into the middle of the image, reads it back and counts pixels.

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <vulkan/vulkan.h>

#include <selvedge.h>

#define FORMAT VK_FORMAT_R8G8B8A8_UNORM
#define BORDER 16u

// Prints a failed call and returns; `finish` frees the objects that exist by then.
#define VK(call)                                                                     \
    do {                                                                             \
        VkResult result = (call);                                                    \
        if (result != VK_SUCCESS) {                                                  \
            fprintf(stderr, "%s: VkResult %d\n", #call, (int)result);                \
            return 1;                                                                \
        }                                                                            \
    } while (0)
#define SELVEDGE(call)                                                               \
    do {                                                                             \
        if ((call) != SELVEDGE_STATUS_OK) {                                          \
            fprintf(stderr, "%s: %s\n", #call, selvedge_last_error());               \
            return 1;                                                                \
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
    VkImage image;
    VkDeviceMemory image_memory;
    VkImageView view;
    VkBuffer copy;
    VkDeviceMemory copy_memory;
    SelvedgeModel* model;
    SelvedgeHost* renderer;
    uint32_t width, height; // of the image
} Host;

static SelvedgeVulkan lent(const Host* h)
{
    return (SelvedgeVulkan){
        .struct_size = sizeof(SelvedgeVulkan),
        .get_instance_proc_addr = (SelvedgeGetInstanceProcAddr)vkGetInstanceProcAddr,
        .instance = h->instance,
        .physical_device = h->physical,
        .device = h->device,
        .queue_family = h->family,
        .slots = 1,
        .colour_format = FORMAT,
    };
}

// The first physical device that lacks nothing.
static int choose(Host* h)
{
    VkPhysicalDevice all[16];
    uint32_t count = 16;
    const VkResult found = vkEnumeratePhysicalDevices(h->instance, &count, all);
    if (found != VK_SUCCESS && found != VK_INCOMPLETE) {
        return 1;
    }
    for (uint32_t i = 0; i < count; ++i) {
        h->physical = all[i];
        const SelvedgeVulkan vulkan = lent(h);
        if (selvedge_vulkan_missing(&vulkan) != SELVEDGE_STATUS_OK) {
            fprintf(stderr, "device %u: %s\n", i, selvedge_last_error());
            continue;
        }
        VkQueueFamilyProperties families[16];
        uint32_t family_count = 16;
        vkGetPhysicalDeviceQueueFamilyProperties(h->physical, &family_count, families);
        const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
        for (h->family = 0; h->family < family_count; ++h->family) {
            if ((families[h->family].queueFlags & wanted) == wanted) {
                return 0;
            }
        }
    }
    fprintf(stderr, "no device suffices\n");
    return 1;
}

static int make_device(Host* h)
{
    const VkApplicationInfo app = { .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3 };
    const VkInstanceCreateInfo instance = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pApplicationInfo = &app,
    };
    VK(vkCreateInstance(&instance, NULL, &h->instance));
    if (choose(h) != 0) {
        return 1;
    }
    // a host sets the features that it needs itself in these structs, too
    VkPhysicalDeviceFeatures core = { 0 };
    VkPhysicalDeviceVulkan13Features v13 = { .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES };
    VkPhysicalDeviceVulkan12Features v12 = { .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES };
    SELVEDGE(selvedge_vulkan_features(&core, &v12, &v13));
    v12.pNext = &v13;
    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = h->family,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    const char* extensions[] = { VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME };
    const VkDeviceCreateInfo device = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &v12,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .enabledExtensionCount = 1,
        .ppEnabledExtensionNames = extensions,
        .pEnabledFeatures = &core,
    };
    VK(vkCreateDevice(h->physical, &device, NULL, &h->device));
    vkGetDeviceQueue(h->device, h->family, 0, &h->queue);
    const VkCommandPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
        .queueFamilyIndex = h->family,
    };
    VK(vkCreateCommandPool(h->device, &pool, NULL, &h->pool));
    const VkCommandBufferAllocateInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = h->pool,
        .commandBufferCount = 1,
    };
    VK(vkAllocateCommandBuffers(h->device, &commands, &h->commands));
    const VkFenceCreateInfo fence = { .sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO };
    VK(vkCreateFence(h->device, &fence, NULL, &h->fence));
    return 0;
}

static int allocate(const Host* h, VkMemoryRequirements wanted, VkMemoryPropertyFlags flags, VkDeviceMemory* memory)
{
    VkPhysicalDeviceMemoryProperties types;
    vkGetPhysicalDeviceMemoryProperties(h->physical, &types);
    for (uint32_t i = 0; i < types.memoryTypeCount; ++i) {
        if ((wanted.memoryTypeBits >> i & 1) != 0 && (types.memoryTypes[i].propertyFlags & flags) == flags) {
            const VkMemoryAllocateInfo info = {
                .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                .allocationSize = wanted.size,
                .memoryTypeIndex = i,
            };
            VK(vkAllocateMemory(h->device, &info, NULL, memory));
            return 0;
        }
    }
    return 1;
}

static const VkImageSubresourceRange WHOLE = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 };

static int make_image(Host* h)
{
    const VkImageCreateInfo image = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = FORMAT,
        .extent = { h->width, h->height, 1 },
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
    };
    VK(vkCreateImage(h->device, &image, NULL, &h->image));
    VkMemoryRequirements wanted;
    vkGetImageMemoryRequirements(h->device, h->image, &wanted);
    if (allocate(h, wanted, 0, &h->image_memory) != 0) {
        return 1;
    }
    VK(vkBindImageMemory(h->device, h->image, h->image_memory, 0));
    const VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = h->image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = FORMAT,
        .subresourceRange = WHOLE,
    };
    VK(vkCreateImageView(h->device, &view, NULL, &h->view));
    const VkBufferCreateInfo copy = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = (VkDeviceSize)h->width * h->height * 4,
        .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
    };
    VK(vkCreateBuffer(h->device, &copy, NULL, &h->copy));
    vkGetBufferMemoryRequirements(h->device, h->copy, &wanted);
    const VkMemoryPropertyFlags seen = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    if (allocate(h, wanted, seen, &h->copy_memory) != 0) {
        return 1;
    }
    VK(vkBindBufferMemory(h->device, h->copy, h->copy_memory, 0));
    return 0;
}

typedef struct {
    VkPipelineStageFlags stage;
    VkAccessFlags access;
    VkImageLayout layout;
} Use;

static const Use NEW = { VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED };
static const Use CLEAR = { VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL };
static const Use DRAW = { VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                          VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                          VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL };
static const Use COPY = { VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT,
                          VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL };

static void barrier(const Host* h, Use before, Use after)
{
    const VkImageMemoryBarrier image = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = before.access,
        .dstAccessMask = after.access,
        .oldLayout = before.layout,
        .newLayout = after.layout,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = h->image,
        .subresourceRange = WHOLE,
    };
    vkCmdPipelineBarrier(h->commands, before.stage, after.stage, 0, 0, NULL, 0, NULL, 1, &image);
}

// Draws one frame and waits for it: the host's blue, and the model in a rectangle of the image.
static int frame(const Host* h)
{
    const VkCommandBufferBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
    };
    VK(vkBeginCommandBuffer(h->commands, &begin));
    barrier(h, NEW, CLEAR);
    const VkClearColorValue blue = { .float32 = { 0.0f, 0.0f, 1.0f, 1.0f } };
    vkCmdClearColorImage(h->commands, h->image, CLEAR.layout, &blue, 1, &WHOLE);
    barrier(h, CLEAR, DRAW);
    const SelvedgeView view = {
        .struct_size = sizeof view,
        .width = h->width - 2 * BORDER,
        .height = h->height - 2 * BORDER,
        .standard = "iso",
    };
    const SelvedgeTargets targets = {
        .struct_size = sizeof targets,
        .width = h->width,
        .height = h->height,
        .x = BORDER,
        .y = BORDER,
        .colour = { (uint64_t)(uintptr_t)h->image, (uint64_t)(uintptr_t)h->view },
    };
    SELVEDGE(selvedge_host_record(h->renderer, h->commands, 0, &view, &targets));
    barrier(h, DRAW, COPY);
    const VkBufferImageCopy region = {
        .imageSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 },
        .imageExtent = { h->width, h->height, 1 },
    };
    vkCmdCopyImageToBuffer(h->commands, h->image, COPY.layout, h->copy, 1, &region);
    const VkMemoryBarrier seen = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_HOST_READ_BIT,
    };
    vkCmdPipelineBarrier(h->commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &seen, 0, NULL,
                         0, NULL);
    VK(vkEndCommandBuffer(h->commands));
    const VkSubmitInfo submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
        .commandBufferCount = 1,
        .pCommandBuffers = &h->commands,
    };
    VK(vkQueueSubmit(h->queue, 1, &submit, h->fence));
    VK(vkWaitForFences(h->device, 1, &h->fence, VK_TRUE, UINT64_MAX));
    VK(vkResetFences(h->device, 1, &h->fence));
    return 0;
}

// Counts the pixels that are not the host's blue, within the rectangle and outside of it.
static int count(const Host* h)
{
    void* bytes = NULL;
    VK(vkMapMemory(h->device, h->copy_memory, 0, VK_WHOLE_SIZE, 0, &bytes));
    const unsigned char* pixels = bytes;
    const unsigned char blue[4] = { 0, 0, 255, 255 };
    size_t seen = 0, beside = 0;
    for (uint32_t y = 0; y < h->height; ++y) {
        for (uint32_t x = 0; x < h->width; ++x) {
            const int inside = x >= BORDER && y >= BORDER && x < h->width - BORDER && y < h->height - BORDER;
            if (memcmp(pixels + 4 * ((size_t)y * h->width + x), blue, 4) != 0) {
                *(inside ? &seen : &beside) += 1;
            }
        }
    }
    vkUnmapMemory(h->device, h->copy_memory);
    printf("%zu pixels show the model, %zu beside its rectangle\n", seen, beside);
    return seen == 0 || beside != 0;
}

static int run(Host* h, const char* path)
{
    SELVEDGE(selvedge_open(path, NULL, &h->model));
    if (make_device(h) != 0 || make_image(h) != 0) {
        return 1;
    }
    const SelvedgeVulkan vulkan = lent(h);
    SELVEDGE(selvedge_host_new(&vulkan, &h->renderer));
    const SelvedgeView settings = { .struct_size = sizeof settings };
    SELVEDGE(selvedge_host_upload(h->renderer, h->model, &settings));
    SelvedgeReport report = { .struct_size = sizeof report };
    do {
        if (frame(h) != 0) {
            return 1;
        }
        SELVEDGE(selvedge_host_report(h->renderer, 0, &report));
    } while (!report.complete); // if a list was too short, the next frame has room for all of it
    return count(h);
}

// Frees the renderer first: it uses the device.
static void finish(Host* h)
{
    selvedge_host_free(h->renderer);
    selvedge_model_free(h->model);
    if (h->device != NULL) {
        vkDestroyBuffer(h->device, h->copy, NULL);
        vkFreeMemory(h->device, h->copy_memory, NULL);
        vkDestroyImageView(h->device, h->view, NULL);
        vkDestroyImage(h->device, h->image, NULL);
        vkFreeMemory(h->device, h->image_memory, NULL);
        vkDestroyFence(h->device, h->fence, NULL);
        vkDestroyCommandPool(h->device, h->pool, NULL);
        vkDestroyDevice(h->device, NULL);
    }
    if (h->instance != NULL) {
        vkDestroyInstance(h->instance, NULL);
    }
}

int main(int argument_count, char** arguments)
{
    if (argument_count != 4) {
        fprintf(stderr, "usage: %s FILE WIDTH HEIGHT\n", arguments[0]);
        return 2;
    }
    Host host = { .width = (uint32_t)atoi(arguments[2]), .height = (uint32_t)atoi(arguments[3]) };
    if (host.width <= 2 * BORDER || host.height <= 2 * BORDER) {
        fprintf(stderr, "the picture has no room\n");
        return 2;
    }
    const int bad = run(&host, arguments[1]);
    finish(&host);
    return bad;
}
