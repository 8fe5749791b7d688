// A scene that lives on a host's device: what is refused, instances that change, models that come and go, a pixel that
// is read back, a frame that is discarded, a device that is lost, lengths within solids.

#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>

#include "../../../examples/c/commands.h"
#include "check.h"

enum { WIDTH = 64, HEIGHT = 48 };

// From above, two pixels a millimetre: the top of the block is 4 x 6 pixels in the middle, 45 mm away.
static SelvedgeView above(void)
{
    return (SelvedgeView){
        .struct_size = sizeof(SelvedgeView),
        .width = WIDTH,
        .height = HEIGHT,
        .eye = { 1.0, 1.5, 50.0 },
        .target = { 1.0, 1.5, 0.0 },
        .up = { 0.0, 1.0, 0.0 },
        .ortho = HEIGHT / 2.0,
        .ambient = -1.0,
    };
}

typedef struct {
    Image colour, instance, thickness;
    int has_thickness; // of the next frames
    VkPipelineCache pipelines;
} Images;

static SelvedgeTarget target(const Image* image)
{
    return (SelvedgeTarget){ (uint64_t)(uintptr_t)image->image, (uint64_t)(uintptr_t)image->view };
}

static SelvedgeTargets targets_of(const Images* images)
{
    return (SelvedgeTargets){
        .struct_size = sizeof(SelvedgeTargets),
        .colour = target(&images->colour),
        .instance = target(&images->instance),
        .thickness = images->has_thickness ? target(&images->thickness) : (SelvedgeTarget){ 0, 0 },
    };
}

// Begins a command buffer with the host's black and no instance, and records the model over it.
static int record(const Device* d, const Images* images, const SelvedgeHost* host)
{
    if (begin_commands(d) != 0) {
        return 1;
    }
    barrier(d, &images->colour, NEW, CLEAR);
    const VkClearColorValue black = { .float32 = { 0.0f, 0.0f, 0.0f, 1.0f } };
    vkCmdClearColorImage(d->commands, images->colour.image, CLEAR.layout, &black, 1, &WHOLE);
    barrier(d, &images->colour, CLEAR, DRAW);
    // without a background each image stays as it is where the model is not
    barrier(d, &images->instance, NEW, CLEAR);
    const VkClearColorValue none = { .uint32 = { 0 } };
    vkCmdClearColorImage(d->commands, images->instance.image, CLEAR.layout, &none, 1, &WHOLE);
    barrier(d, &images->instance, CLEAR, DRAW);
    if (images->has_thickness) {
        barrier(d, &images->thickness, NEW, DRAW);
    }
    const SelvedgeView view = above();
    const SelvedgeTargets targets = targets_of(images);
    SELVEDGE(selvedge_host_record(host, d->commands, 0, &view, &targets));
    return 0;
}

// Draws until the frame is whole.
static int draw(const Device* d, const Images* images, const SelvedgeHost* host)
{
    SelvedgeReport report = { .struct_size = sizeof report };
    do {
        if (record(d, images, host) != 0) {
            return 1;
        }
        barrier(d, &images->colour, DRAW, COPY);
        read_back(d, &images->colour);
        barrier(d, &images->instance, DRAW, COPY);
        read_back(d, &images->instance);
        if (images->has_thickness) {
            barrier(d, &images->thickness, DRAW, COPY);
            read_back(d, &images->thickness);
        }
        if (submit_and_wait(d) != 0) {
            return 1;
        }
        SELVEDGE(selvedge_host_report(host, 0, &report));
        HOLDS(report.recorded == 1 && report.clamps == 0);
    } while (!report.complete);
    return 0;
}

typedef struct {
    size_t left, right; // pixels that show a model: the right side begins 2 mm beside the block
    size_t red, green; // those of these colours
    size_t instances[3]; // pixels of the image of instances with the numbers 0, 1 and 2
} Seen;

static int look(const Device* d, const Images* images, const SelvedgeHost* host, Seen* seen)
{
    if (draw(d, images, host) != 0) {
        return 1;
    }
    void* bytes = NULL;
    VK(vkMapMemory(d->device, images->colour.copy_memory, 0, VK_WHOLE_SIZE, 0, &bytes));
    *seen = (Seen){ 0 };
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
        const unsigned char* p = (const unsigned char*)bytes + 4 * i;
        if (p[0] > 40 || p[1] > 40 || p[2] > 40) {
            *(i % WIDTH < WIDTH / 2 + 6 ? &seen->left : &seen->right) += 1;
            seen->red += p[0] > p[1] + 40;
            seen->green += p[1] > p[0] + 40;
        }
    }
    vkUnmapMemory(d->device, images->colour.copy_memory);
    VK(vkMapMemory(d->device, images->instance.copy_memory, 0, VK_WHOLE_SIZE, 0, &bytes));
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
        const uint32_t number = ((const uint32_t*)bytes)[i];
        HOLDS(number < 3);
        seen->instances[number] += 1;
    }
    vkUnmapMemory(d->device, images->instance.copy_memory);
    return 0;
}

// The border of a block is at borders of pixels: smooth edges may show in those beside it.
static int is_block(size_t pixels)
{
    return pixels >= 24 && pixels <= 44;
}

#define LOOK() HOLDS(look(d, images, host, &seen) == 0)

static int mistakes_before_an_upload(const Device* d, const Images* images, const SelvedgeHost* host,
                                     const SelvedgeModel* model)
{
    SelvedgeView view = above();
    const SelvedgeTargets targets = targets_of(images);
    SelvedgeReport report = { .struct_size = sizeof report, .recorded = 7 };
    WANT(OK, selvedge_host_report(host, 0, &report), "");
    HOLDS(report.recorded == 0 && report.complete == 0);
    WANT(ARGUMENT, selvedge_host_report(host, 1, &report), "slot 1 of 1");
    WANT(ARGUMENT, selvedge_host_report(host, 0, NULL), "null pointer");
    WANT(ARGUMENT, selvedge_host_record(host, d->commands, 0, &view, &targets), "no model was uploaded");
    WANT(ARGUMENT, selvedge_host_set_visible(host, 0, 1), "no model was uploaded");
    WANT(ARGUMENT, selvedge_host_pick(host, 0, 0), "no model was uploaded");
    uint64_t added = 7;
    WANT(ARGUMENT, selvedge_host_add(host, model, &added), "no model was uploaded");
    HOLDS(added == 0);
    WANT(ARGUMENT, selvedge_host_upload(host, NULL, &view), "model is a null pointer");
    view.samples = 3;
    WANT(ARGUMENT, selvedge_host_upload(host, model, &view), "1, 4 or 8");
    return 0;
}

static int mistakes_of_frames(const Device* d, const Images* images, const SelvedgeHost* host)
{
    const SelvedgeView view = above();
    const SelvedgeTargets targets = targets_of(images);
    WANT(ARGUMENT, selvedge_host_record(host, NULL, 0, &view, &targets), "command buffer is a null handle");
    WANT(ARGUMENT, selvedge_host_record(host, d->commands, 1, &view, &targets), "slot 1 of 1");
#define BAD(of, what, change, status, words)                                                       \
    do {                                                                                           \
        SelvedgeView bad_view = view;                                                              \
        SelvedgeTargets bad_targets = targets;                                                     \
        bad_##of.what = (change);                                                                  \
        WANT(status, selvedge_host_record(host, d->commands, 0, &bad_view, &bad_targets), words);  \
    } while (0)
    BAD(view, width, 0, ARGUMENT, "no pixels");
    BAD(view, tolerance, NAN, ARGUMENT, "0.1");
    BAD(view, background, "whitish", ARGUMENT, "CSS colour");
    BAD(targets, colour.image, 0, ARGUMENT, "lacks its image of colour");
    BAD(targets, colour.view, 0, ARGUMENT, "has no view");
    BAD(targets, depth.image, 1, ARGUMENT, "without an image of depth");
    BAD(targets, instance.image, 0, ARGUMENT, "lacks its image of instance");
    BAD(targets, thickness.image, 1, ARGUMENT, "without an image of thickness");
    BAD(targets, x, 1, RENDER, "is not within it");
    BAD(targets, struct_size, 2, ARGUMENT, "struct_size");
    return 0;
}

static int changes(const Device* d, const Images* images, const SelvedgeHost* host)
{
    Seen seen;
    LOOK();
    HOLDS(is_block(seen.left) && seen.right == 0 && seen.red == 0 && seen.green == 0);
    HOLDS(seen.instances[1] == 24 && seen.instances[2] == 0);

    double moved[12] = { 1, 0, 0, 0, 1, 0, 0, 0, 1, 6, 0, 0 };
    WANT(OK, selvedge_host_set_transform(host, 0, moved), "");
    LOOK();
    HOLDS(seen.left == 0 && is_block(seen.right));
    WANT(ARGUMENT, selvedge_host_set_transform(host, 1, moved), "no instance 1");
    WANT(ARGUMENT, selvedge_host_set_transform(host, UINT64_MAX, moved), "no instance");
    WANT(ARGUMENT, selvedge_host_set_transform(host, 0, NULL), "transform is a null pointer");
    moved[9] = NAN;
    WANT(ARGUMENT, selvedge_host_set_transform(host, 0, moved), "is not finite");
    const double huge[12] = { 1e103, 0, 0, 0, 1e103, 0, 0, 0, 1e103, 0, 0, 0 };
    WANT(ARGUMENT, selvedge_host_set_transform(host, 0, huge), "1e30 times longer or shorter");

    WANT(OK, selvedge_host_set_visible(host, 0, 0), "");
    LOOK();
    HOLDS(seen.left == 0 && seen.right == 0);
    WANT(ARGUMENT, selvedge_host_set_visible(host, 1, 0), "no instance 1");
    WANT(OK, selvedge_host_set_visible(host, 0, 1), "");

    const float red[4] = { 1, 0, 0, 1 }, green[4] = { 0, 1, 0, 1 }, no_colour[4] = { 2, 0, 0, 1 };
    WANT(OK, selvedge_host_set_colour(host, 0, red), "");
    LOOK();
    HOLDS(is_block(seen.right) && is_block(seen.red));
    WANT(ARGUMENT, selvedge_host_set_colour(host, 1, red), "no instance 1");
    WANT(ARGUMENT, selvedge_host_set_colour(host, 0, no_colour), "not between 0 and 1");
    WANT(OK, selvedge_host_set_selected(host, 0, green), "");
    LOOK();
    HOLDS(seen.red == 0 && is_block(seen.green));
    WANT(ARGUMENT, selvedge_host_set_selected(host, 0, no_colour), "not between 0 and 1");
    WANT(OK, selvedge_host_set_selected(host, 0, NULL), "");
    WANT(OK, selvedge_host_set_colour(host, 0, NULL), "");
    LOOK();
    HOLDS(is_block(seen.right) && seen.red == 0 && seen.green == 0);
    return 0;
}

static int models(const Device* d, const Images* images, const SelvedgeHost* host, const SelvedgeModel* model)
{
    Seen seen;
    uint64_t added = 0, first = 7, count = 7;
    WANT(ARGUMENT, selvedge_host_add(host, NULL, &added), "model is a null pointer");
    WANT(ARGUMENT, selvedge_host_add(host, model, NULL), "null pointer");
    WANT(OK, selvedge_host_add(host, model, &added), "");
    WANT(OK, selvedge_host_instances(host, added, &first, &count), "");
    HOLDS(added != 0 && first == 1 && count == 1);
    WANT(ARGUMENT, selvedge_host_instances(host, added, NULL, &count), "null pointer");
    WANT(ARGUMENT, selvedge_host_instances(host, added + 1, &first, &count), "no added model has the number");

    SelvedgeHit hit = { .struct_size = sizeof hit, .face = 7 };
    WANT(OK, selvedge_host_pick(host, WIDTH / 2, HEIGHT / 2), "");
    LOOK();
    HOLDS(is_block(seen.left) && is_block(seen.right));
    HOLDS(seen.instances[1] == 24 && seen.instances[2] == 24);
    WANT(OK, selvedge_host_picked(host, 0, &hit), "");
    HOLDS(hit.face > 0 && hit.part == 2 && hit.instance == 2 && hit.edge_of_part == 0);
    HOLDS(fabs(hit.point[0] - 1.25) < 1e-6 && fabs(hit.point[1] - 1.25) < 1e-6 && fabs(hit.point[2] - 5.0) < 1e-6);
    HOLDS(fabs(hit.normal[2] - 1.0) < 1e-9 && fabs(hit.depth - 45.0) < 1e-6);
    WANT(OK, selvedge_host_pick(host, 0, 0), "");
    LOOK();
    WANT(OK, selvedge_host_picked(host, 0, &hit), "");
    HOLDS(hit.face == 0 && hit.instance == 0 && hit.depth == 0.0);
    WANT(ARGUMENT, selvedge_host_picked(host, 1, &hit), "slot 1 of 1");
    WANT(ARGUMENT, selvedge_host_picked(host, 0, NULL), "null pointer");

    WANT(OK, selvedge_host_remove(host, added), "");
    LOOK();
    HOLDS(seen.left == 0 && is_block(seen.right));
    WANT(ARGUMENT, selvedge_host_remove(host, added), "no added model has the number");
    WANT(ARGUMENT, selvedge_host_set_visible(host, first, 1), "no instance 1");

    // an upload takes the place of all, and no number comes back
    uint64_t gone = 0, again = 0;
    const SelvedgeView view = above();
    WANT(OK, selvedge_host_add(host, model, &gone), "");
    WANT(OK, selvedge_host_upload(host, model, &view), "");
    WANT(ARGUMENT, selvedge_host_remove(host, gone), "no added model has the number");
    WANT(OK, selvedge_host_add(host, model, &again), "");
    HOLDS(again != gone && again != added);
    WANT(OK, selvedge_host_remove(host, again), "");
    LOOK();
    HOLDS(is_block(seen.left) && seen.right == 0);
    return 0;
}

typedef struct {
    const SelvedgeHost* host;
    atomic_int done;
} Mover;

static void* move_to_and_fro(void* with)
{
    Mover* mover = with;
    double at[12] = { 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0 };
    while (!atomic_load(&mover->done)) {
        at[9] = 6.0 - at[9];
        if (selvedge_host_set_transform(mover->host, 0, at) != OK || *selvedge_last_error() != 0) {
            return "a transform was refused, or the error is the other thread's";
        }
        sched_yield();
    }
    return NULL;
}

// One thread moves the block while another draws: each frame shows it at one of its places.
static int threads(const Device* d, const Images* images, const SelvedgeHost* host)
{
    Mover mover = { .host = host };
    pthread_t thread;
    HOLDS(pthread_create(&thread, NULL, move_to_and_fro, &mover) == 0);
    int bad = 0;
    for (int frame = 0; frame < 4 && !bad; ++frame) {
        Seen seen;
        bad = selvedge_host_set_visible(host, 9, 0) != ARGUMENT
            || strstr(selvedge_last_error(), "no instance 9") == NULL
            || look(d, images, host, &seen) != 0
            || !(is_block(seen.left) ? seen.right == 0 : seen.left == 0 && is_block(seen.right));
    }
    atomic_store(&mover.done, 1);
    void* wrong = NULL;
    HOLDS(pthread_join(thread, &wrong) == 0 && wrong == NULL);
    HOLDS(!bad);
    return 0;
}

// A frame that the host drops, and then a device that is lost.
static int losses(const Device* d, const Images* images, const SelvedgeHost* host)
{
    Seen seen;
    const double moved[12] = { 1, 0, 0, 0, 1, 0, 0, 0, 1, 6, 0, 0 };
    WANT(OK, selvedge_host_set_transform(host, 0, moved), "");
    HOLDS(record(d, images, host) == 0);
    VK(vkEndCommandBuffer(d->commands));
    WANT(ARGUMENT, selvedge_host_discard(host, 1), "slot 1 of 1");
    WANT(OK, selvedge_host_discard(host, 0), "");
    SelvedgeReport report = { .struct_size = sizeof report };
    WANT(OK, selvedge_host_report(host, 0, &report), "");
    HOLDS(report.recorded == 0);
    LOOK();
    HOLDS(seen.left == 0 && is_block(seen.right));

    WANT(OK, selvedge_host_device_lost(host), "");
    const SelvedgeView view = above();
    const SelvedgeTargets targets = targets_of(images);
    WANT(RENDER, selvedge_host_record(host, d->commands, 0, &view, &targets), "lost");
    return 0;
}

// No model has room in a byte.
static int little(const Device* d, const SelvedgeModel* model)
{
    SelvedgeVulkan vulkan = lent(d);
    vulkan.limit_bytes = 1;
    SelvedgeHost* host = NULL;
    const SelvedgeView view = above();
    SelvedgeStatus status = selvedge_host_new(&vulkan, &host);
    if (status == OK) {
        status = selvedge_host_upload(host, model, &view);
    }
    const int is_refused = status == RENDER && strstr(selvedge_last_error(), "are left of 1") != NULL;
    selvedge_host_free(host);
    HOLDS(is_refused);
    return 0;
}

// A host with a cache of pipelines, and with lengths of rays within solids: the block is 5 mm high.
static int lengths(const Device* d, Images* images, const SelvedgeModel* model, SelvedgeHost** second)
{
    SelvedgeVulkan vulkan = lent(d);
    vulkan.pipeline_cache = (uint64_t)(uintptr_t)images->pipelines;
    vulkan.outputs = SELVEDGE_INSTANCE | SELVEDGE_THICKNESS;
    WANT(OK, selvedge_host_new(&vulkan, second), "");
    const SelvedgeHost* host = *second;
    const SelvedgeView view = above();
    WANT(OK, selvedge_host_upload(host, model, &view), "");
    Seen seen;
    images->has_thickness = 1;
    LOOK();
    HOLDS(is_block(seen.left) && seen.instances[1] == 24);
    void* bytes = NULL;
    VK(vkMapMemory(d->device, images->thickness.copy_memory, 0, VK_WHOLE_SIZE, 0, &bytes));
    size_t within = 0, outside = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
        const float length = ((const float*)bytes)[i];
        within += fabsf(length - 5.0f) < 1e-4f;
        outside += length == 0.0f;
    }
    vkUnmapMemory(d->device, images->thickness.copy_memory);
    HOLDS(within == 24 && within + outside == WIDTH * HEIGHT);
    images->has_thickness = 0;
    LOOK();
    HOLDS(is_block(seen.left) && seen.instances[1] == 24);
    WANT(ARGUMENT, selvedge_host_set_visible(host, 0, 0), "rays are followed through instance 0");
    return 0;
}

static int run(Device* d, Images* images, const SelvedgeModel* model, SelvedgeHost** host)
{
    if (make_device(d) != 0 || make_commands(d) != 0 || make_image(d, &images->colour) != 0
        || make_image(d, &images->instance) != 0 || make_image(d, &images->thickness) != 0) {
        return 1;
    }
    const VkPipelineCacheCreateInfo cache = { .sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO };
    VK(vkCreatePipelineCache(d->device, &cache, NULL, &images->pipelines));
    SelvedgeVulkan vulkan = lent(d);
    vulkan.outputs = 1u << 30;
    WANT(ARGUMENT, selvedge_host_new(&vulkan, host), "no image");
    vulkan = lent(d);
    vulkan.queue_family = 99;
    WANT(ARGUMENT, selvedge_host_new(&vulkan, host), "queue family 99");
    vulkan = lent(d);
    vulkan.colour_format = 0;
    WANT(ARGUMENT, selvedge_host_new(&vulkan, host), "VK_FORMAT_UNDEFINED");
    vulkan = lent(d);
    vulkan.outputs = SELVEDGE_INSTANCE;
    WANT(OK, selvedge_host_new(&vulkan, host), "");
    if (mistakes_before_an_upload(d, images, *host, model) != 0) {
        return 1;
    }
    const SelvedgeView view = above();
    WANT(OK, selvedge_host_upload(*host, model, &view), "");
    return mistakes_of_frames(d, images, *host) != 0 || changes(d, images, *host) != 0
        || models(d, images, *host, model) != 0 || threads(d, images, *host) != 0 || losses(d, images, *host) != 0;
}

int main(void)
{
    SelvedgeModel* model = NULL;
    WANT(OK, selvedge_open_bytes(BLOCK, sizeof BLOCK - 1, "block.obj", NULL, &model), "");
    Images images = { .colour = { .width = WIDTH, .height = HEIGHT, .format = FORMAT },
                      .instance = { .width = WIDTH, .height = HEIGHT, .format = VK_FORMAT_R32_UINT },
                      .thickness = { .width = WIDTH, .height = HEIGHT, .format = VK_FORMAT_R32_SFLOAT } };
    Device device = { 0 };
    SelvedgeHost *host = NULL, *second = NULL;
    const int bad = run(&device, &images, model, &host) != 0 || little(&device, model) != 0
        || lengths(&device, &images, model, &second) != 0;
    selvedge_host_free(host);
    selvedge_host_free(second);
    selvedge_model_free(model);
    if (device.device != NULL) {
        free_image(&device, &images.colour);
        free_image(&device, &images.instance);
        free_image(&device, &images.thickness);
        vkDestroyPipelineCache(device.device, images.pipelines, NULL);
    }
    free_device(&device);
    return bad;
}
