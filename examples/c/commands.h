// A command buffer of the host's own: begun, submitted and waited for, one frame at a time.

#ifndef HOST_COMMANDS_H
#define HOST_COMMANDS_H

#include "image.h"

// Of the host's images, in the order of a frame.
static const Use NEW = { VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED };
static const Use CLEAR = { VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL };
static const Use DRAW = { VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                          VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                          VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL };
static const Use COPY = { VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT,
                          VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL };

static int make_commands(Device* d)
{
    const VkCommandPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
        .queueFamilyIndex = d->family,
    };
    VK(vkCreateCommandPool(d->device, &pool, NULL, &d->pool));
    const VkCommandBufferAllocateInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = d->pool,
        .commandBufferCount = 1,
    };
    VK(vkAllocateCommandBuffers(d->device, &commands, &d->commands));
    const VkFenceCreateInfo fence = { .sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO };
    VK(vkCreateFence(d->device, &fence, NULL, &d->fence));
    return 0;
}

static int begin_commands(const Device* d)
{
    const VkCommandBufferBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
    };
    VK(vkBeginCommandBuffer(d->commands, &begin));
    return 0;
}

// Copies the image, which the barrier before has made ready for it, to where the CPU reads it.
static void read_back(const Device* d, const Image* image)
{
    const VkBufferImageCopy region = {
        .imageSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 },
        .imageExtent = { image->width, image->height, 1 },
    };
    const VkImageLayout layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    vkCmdCopyImageToBuffer(d->commands, image->image, layout, image->copy, 1, &region);
    const VkMemoryBarrier seen = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_HOST_READ_BIT,
    };
    vkCmdPipelineBarrier(d->commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &seen, 0, NULL,
                         0, NULL);
}

static int submit_and_wait(const Device* d)
{
    VK(vkEndCommandBuffer(d->commands));
    const VkSubmitInfo submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
        .commandBufferCount = 1,
        .pCommandBuffers = &d->commands,
    };
    VK(vkQueueSubmit(d->queue, 1, &submit, d->fence));
    VK(vkWaitForFences(d->device, 1, &d->fence, VK_TRUE, UINT64_MAX));
    VK(vkResetFences(d->device, 1, &d->fence));
    return 0;
}

static void free_device(const Device* d)
{
    if (d->device != NULL) {
        vkDestroyFence(d->device, d->fence, NULL);
        vkDestroyCommandPool(d->device, d->pool, NULL);
        vkDestroyDevice(d->device, NULL);
    }
    if (d->instance != NULL) {
        vkDestroyInstance(d->instance, NULL);
    }
}

#endif
