// A host with a Vulkan device of its own: selvedge records into the host's command buffer, over the host's picture.
//
//     cc -std=c11 host.c $(pkg-config --cflags --libs selvedge) -lvulkan -o host
//     ./host part.step 640 480
//
// The host clears its image to blue, records the model into the middle of the image, reads it back and counts pixels.
// Its device, image and command buffer are in the headers beside this file.

#include <stdlib.h>
#include <string.h>

#include "commands.h"

#define BORDER 16u

// Draws one frame and waits for it: the host's blue, and the model in a rectangle of the image.
static int frame(const Device* d, const Image* image, SelvedgeHost* renderer)
{
    if (begin_commands(d) != 0) {
        return 1;
    }
    barrier(d, image, NEW, CLEAR);
    const VkClearColorValue blue = { .float32 = { 0.0f, 0.0f, 1.0f, 1.0f } };
    vkCmdClearColorImage(d->commands, image->image, CLEAR.layout, &blue, 1, &WHOLE);
    barrier(d, image, CLEAR, DRAW);
    const SelvedgeView view = {
        .struct_size = sizeof view,
        .width = image->width - 2 * BORDER,
        .height = image->height - 2 * BORDER,
        .standard = "iso",
    };
    const SelvedgeTargets targets = {
        .struct_size = sizeof targets,
        .width = image->width,
        .height = image->height,
        .x = BORDER,
        .y = BORDER,
        .colour = { (uint64_t)(uintptr_t)image->image, (uint64_t)(uintptr_t)image->view },
    };
    SELVEDGE(selvedge_host_record(renderer, d->commands, 0, &view, &targets));
    barrier(d, image, DRAW, COPY);
    read_back(d, image);
    return submit_and_wait(d);
}

// Counts the pixels that are not the host's blue, within the rectangle and outside of it.
static int count(const Device* d, const Image* image)
{
    void* bytes = NULL;
    VK(vkMapMemory(d->device, image->copy_memory, 0, VK_WHOLE_SIZE, 0, &bytes));
    const unsigned char* pixels = bytes;
    const unsigned char blue[4] = { 0, 0, 255, 255 };
    size_t seen = 0, beside = 0;
    for (uint32_t y = 0; y < image->height; ++y) {
        for (uint32_t x = 0; x < image->width; ++x) {
            const int inside = x >= BORDER && y >= BORDER && x < image->width - BORDER && y < image->height - BORDER;
            if (memcmp(pixels + 4 * ((size_t)y * image->width + x), blue, 4) != 0) {
                *(inside ? &seen : &beside) += 1;
            }
        }
    }
    vkUnmapMemory(d->device, image->copy_memory);
    printf("%zu pixels show the model, %zu beside its rectangle\n", seen, beside);
    return seen == 0 || beside != 0;
}

static int run(Device* d, Image* image, const SelvedgeModel* model, SelvedgeHost** renderer)
{
    if (make_device(d) != 0 || make_commands(d) != 0 || make_image(d, image) != 0) {
        return 1;
    }
    const SelvedgeVulkan vulkan = lent(d);
    SELVEDGE(selvedge_host_new(&vulkan, renderer));
    const SelvedgeView settings = { .struct_size = sizeof settings };
    SELVEDGE(selvedge_host_upload(*renderer, model, &settings));
    SelvedgeReport report = { .struct_size = sizeof report };
    do {
        if (frame(d, image, *renderer) != 0) {
            return 1;
        }
        SELVEDGE(selvedge_host_report(*renderer, 0, &report));
    } while (!report.complete); // if a list was too short, the next frame has room for all of it
    return count(d, image);
}

int main(int argument_count, char** arguments)
{
    Image image = { .format = FORMAT };
    if (argument_count == 4) {
        image.width = (uint32_t)atoi(arguments[2]);
        image.height = (uint32_t)atoi(arguments[3]);
    }
    if (image.width <= 2 * BORDER || image.height <= 2 * BORDER) {
        fprintf(stderr, "usage: %s FILE WIDTH HEIGHT, each side above %u\n", arguments[0], 2 * BORDER);
        return 2;
    }
    SelvedgeModel* model = NULL;
    SELVEDGE(selvedge_open(arguments[1], NULL, &model));
    Device device = { 0 };
    SelvedgeHost* renderer = NULL;
    const int bad = run(&device, &image, model, &renderer);
    selvedge_host_free(renderer); // before the device, which it uses
    selvedge_model_free(model);
    if (device.device != NULL) {
        free_image(&device, &image);
    }
    free_device(&device);
    return bad;
}
