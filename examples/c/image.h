// An image of the host's own, with memory that the CPU reads it from.

#ifndef HOST_IMAGE_H
#define HOST_IMAGE_H

#include "device.h"

typedef struct {
    uint32_t width, height;
    VkFormat format; // of 4 bytes a pixel
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view;
    VkBuffer copy;
    VkDeviceMemory copy_memory;
} Image;

static const VkImageSubresourceRange WHOLE = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 };

static int allocate(const Device* d, VkMemoryRequirements wanted, VkMemoryPropertyFlags flags, VkDeviceMemory* memory)
{
    VkPhysicalDeviceMemoryProperties types;
    vkGetPhysicalDeviceMemoryProperties(d->physical, &types);
    for (uint32_t i = 0; i < types.memoryTypeCount; ++i) {
        if ((wanted.memoryTypeBits >> i & 1) != 0 && (types.memoryTypes[i].propertyFlags & flags) == flags) {
            const VkMemoryAllocateInfo info = {
                .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                .allocationSize = wanted.size,
                .memoryTypeIndex = i,
            };
            VK(vkAllocateMemory(d->device, &info, NULL, memory));
            return 0;
        }
    }
    return 1;
}

static int make_image(const Device* d, Image* image)
{
    const VkImageCreateInfo create = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = image->format,
        .extent = { image->width, image->height, 1 },
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
    };
    VK(vkCreateImage(d->device, &create, NULL, &image->image));
    VkMemoryRequirements wanted;
    vkGetImageMemoryRequirements(d->device, image->image, &wanted);
    if (allocate(d, wanted, 0, &image->memory) != 0) {
        return 1;
    }
    VK(vkBindImageMemory(d->device, image->image, image->memory, 0));
    const VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image->image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = image->format,
        .subresourceRange = WHOLE,
    };
    VK(vkCreateImageView(d->device, &view, NULL, &image->view));
    const VkBufferCreateInfo copy = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = (VkDeviceSize)image->width * image->height * 4,
        .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
    };
    VK(vkCreateBuffer(d->device, &copy, NULL, &image->copy));
    vkGetBufferMemoryRequirements(d->device, image->copy, &wanted);
    const VkMemoryPropertyFlags seen = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    if (allocate(d, wanted, seen, &image->copy_memory) != 0) {
        return 1;
    }
    VK(vkBindBufferMemory(d->device, image->copy, image->copy_memory, 0));
    return 0;
}

static void free_image(const Device* d, const Image* image)
{
    vkDestroyBuffer(d->device, image->copy, NULL);
    vkFreeMemory(d->device, image->copy_memory, NULL);
    vkDestroyImageView(d->device, image->view, NULL);
    vkDestroyImage(d->device, image->image, NULL);
    vkFreeMemory(d->device, image->memory, NULL);
}

typedef struct {
    VkPipelineStageFlags stage;
    VkAccessFlags access;
    VkImageLayout layout;
} Use;

// Orders two uses of the image, and brings it into the layout of the second.
static void barrier(const Device* d, const Image* image, Use before, Use after)
{
    const VkImageMemoryBarrier between = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = before.access,
        .dstAccessMask = after.access,
        .oldLayout = before.layout,
        .newLayout = after.layout,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image->image,
        .subresourceRange = WHOLE,
    };
    vkCmdPipelineBarrier(d->commands, before.stage, after.stage, 0, 0, NULL, 0, NULL, 1, &between);
}

#endif
