// Every call with what must not be given to it: a status and a sentence, never a crash.

#include <assert.h>
#include <math.h>

#include "check.h"

// an older program's view, and a newer one's
typedef struct {
    size_t struct_size;
    uint32_t width, height;
} OldView;

typedef struct {
    SelvedgeView view;
    uint64_t later;
} NewView;

static int files(void)
{
    SelvedgeModel* model = (SelvedgeModel*)1;
    WANT(FILE_ERROR, selvedge_open("no/such/file.step", NULL, &model), "no/such/file.step");
    assert(model == NULL);
    WANT(ARGUMENT, selvedge_open(NULL, NULL, &model), "null pointer");
    WANT(ARGUMENT, selvedge_open("a.step", NULL, NULL), "null pointer");
    WANT(ARGUMENT, selvedge_open("\xff\xfe", NULL, &model), "UTF-8");
    WANT(ARGUMENT, selvedge_open_bytes(NULL, 4, "a.step", NULL, &model), "null pointer");
    WANT(ARGUMENT, selvedge_open_bytes(BLOCK, (size_t)-1, "a.obj", NULL, &model), "more than memory");
    WANT(FILE_ERROR, selvedge_open_bytes("ISO-10303-21;\n", 14, "cut.step", NULL, &model), "cut.step:");
    WANT(FILE_ERROR, selvedge_open_bytes("group();", 8, "none.csg", NULL, &model), "nothing of it can be drawn");
    SelvedgeReadOptions few = { .struct_size = sizeof few, .limit_bytes = 10 };
    WANT(FILE_ERROR, selvedge_open_bytes(BLOCK, sizeof BLOCK - 1, "a.obj", &few, &model), "10 bytes");
    few.struct_size = 0;
    WANT(ARGUMENT, selvedge_open_bytes(BLOCK, sizeof BLOCK - 1, "a.obj", &few, &model), "struct_size is 0");
    SelvedgeReadOptions late = { .struct_size = sizeof late, .limit_s = 1e-9 };
    WANT(FILE_ERROR, selvedge_open_bytes(BLOCK, sizeof BLOCK - 1, "a.obj", &late, &model), "longer than the limit");
    late.limit_s = NAN;
    WANT(ARGUMENT, selvedge_open_bytes(BLOCK, sizeof BLOCK - 1, "a.obj", &late, &model), "limit_s");
    late.limit_s = -1.0;
    WANT(ARGUMENT, selvedge_open_bytes(BLOCK, sizeof BLOCK - 1, "a.obj", &late, &model), "limit_s");
    // one polygon of a vertex that is not there
    char cut[sizeof BLOCK + 16];
    snprintf(cut, sizeof cut, "%sf 1 2 99\n", BLOCK);
    SelvedgeReadOptions strict = { .struct_size = sizeof strict, .strict = 1 };
    WANT(FILE_ERROR, selvedge_open_bytes(cut, strlen(cut), "cut.obj", &strict, &model), "left out");
    WANT(OK, selvedge_open_bytes(cut, strlen(cut), "cut.obj", NULL, &model), "");
    SelvedgeModelInfo info = { .struct_size = sizeof info };
    WANT(OK, selvedge_model_info(model, &info), "");
    assert(info.complete == 0 && info.warnings > 0 && info.low[0] == 0.0 && info.high[2] == 5.0);
    SelvedgeWarning warning = { .struct_size = sizeof warning };
    WANT(OK, selvedge_model_warning(model, 0, &warning), "");
    assert(strcmp(warning.file, "cut.obj") == 0 && warning.line == 15 && strstr(warning.message, "left out"));
    WANT(ARGUMENT, selvedge_model_warning(model, info.warnings, &warning), "there is no warning");
    WANT(ARGUMENT, selvedge_model_info(model, NULL), "null pointer");
    WANT(ARGUMENT, selvedge_model_info(NULL, &info), "model is a null pointer");
    // what an older program does not know is not written
    SelvedgeModelInfo older = { .struct_size = sizeof older.struct_size + sizeof older.low, .parts = 77 };
    WANT(OK, selvedge_model_info(model, &older), "");
    assert(older.parts == 77 && older.high[2] == 0.0);
    selvedge_model_free(model);
    selvedge_model_free(NULL);
    return 0;
}

static int views(const SelvedgeRenderer* renderer, const SelvedgeModel* model)
{
    SelvedgePicture* picture = NULL;
    SelvedgeView view = { .struct_size = sizeof view, .width = 48, .height = 32 };
    WANT(ARGUMENT, selvedge_render(NULL, model, &view, &picture), "renderer is a null pointer");
    WANT(ARGUMENT, selvedge_render(renderer, NULL, &view, &picture), "model is a null pointer");
    WANT(ARGUMENT, selvedge_render(renderer, model, NULL, &picture), "view is a null pointer");
    WANT(ARGUMENT, selvedge_render(renderer, model, &view, NULL), "null pointer");
#define BAD(change, words)                                                        \
    do {                                                                          \
        SelvedgeView bad = view;                                                  \
        change;                                                                   \
        WANT(ARGUMENT, selvedge_render(renderer, model, &bad, &picture), words); \
        assert(picture == NULL);                                                  \
    } while (0)
    BAD(bad.width = 0, "no pixels");
    BAD(bad.height = 16385, "16384");
    BAD(bad.standard = "side", "iso, front");
    BAD(bad.standard = "iso,front", "one view");
    BAD(bad.outputs = 1u << 30, "no image");
    BAD(bad.style = "toon", "clay");
    BAD(bad.background = "whitish", "CSS colour");
    BAD(bad.edges = "some", "sharp");
    BAD((bad.edges = "all", bad.line_width = -1.0), "width");
    BAD(bad.samples = 3, "1, 4 or 8");
    BAD(bad.tolerance = NAN, "0.1");
    BAD(bad.sun[1] = NAN, "towards the sun");
    BAD(bad.ambient = INFINITY, "ambient occlusion");
    BAD((bad.style = "mean-curvature", bad.curvature_range = -1.0), "above 0");
    BAD(bad.eye[0] = INFINITY, "not a number");
    BAD((bad.eye[2] = 9.0, bad.up[2] = 1.0), "up direction");
    BAD((bad.eye[0] = 9.0, bad.fov = 20.0, bad.ortho = 2.0), "exclude");
    BAD((bad.intrinsics[0] = 9.0, bad.standard = "iso"), "exclude");
    BAD(bad.intrinsics[0] = 9.0, "fx and fy above 0");
    BAD(bad.translation[2] = 9.0, "with intrinsics");
    BAD((bad.intrinsics[0] = bad.intrinsics[1] = 9.0, bad.rotation[0] = 2.0), "no rotation");
    BAD((bad.intrinsics[0] = bad.intrinsics[1] = 9.0, bad.intrinsics[2] = 2e4), "principal point");

    const OldView old = { sizeof old, 48, 32 };
    WANT(OK, selvedge_render(renderer, model, (const SelvedgeView*)&old, &picture), "");
    SelvedgeImage image = { .struct_size = sizeof image };
    WANT(OK, selvedge_picture_image(picture, SELVEDGE_COLOUR, &image), "");
    assert(image.width == 48 && image.height == 32 && image.channels == 4 && image.kind == SELVEDGE_UINT8);
    WANT(ARGUMENT, selvedge_picture_image(picture, SELVEDGE_DEPTH, &image), "without its depth");
    WANT(ARGUMENT, selvedge_picture_image(picture, SELVEDGE_DEPTH | SELVEDGE_UV, &image), "one image");
    WANT(ARGUMENT, selvedge_picture_image(picture, 0, &image), "one image");
    WANT(ARGUMENT, selvedge_picture_image(NULL, SELVEDGE_COLOUR, &image), "picture is a null pointer");
    WANT(FILE_ERROR, selvedge_picture_save_png(picture, "no/such/folder.png"), "cannot write");
    WANT(FILE_ERROR, selvedge_picture_save_png(picture, "part.step"), "ends in .png");
    selvedge_picture_free(picture);
    selvedge_picture_free(NULL);

    NewView newer = { .view = view };
    newer.view.struct_size = sizeof newer;
    WANT(OK, selvedge_render(renderer, model, &newer.view, &picture), "");
    selvedge_picture_free(picture);
    newer.later = 1;
    WANT(ARGUMENT, selvedge_render(renderer, model, &newer.view, &picture), "beyond");
    return 0;
}

// from above, 9 mm over the ground: the top of the block is 4 mm away
static int images(const SelvedgeRenderer* renderer, const SelvedgeModel* model)
{
    const SelvedgeView view = {
        .struct_size = sizeof view,
        .width = 40,
        .height = 40,
        .eye = { 1.0, 1.5, 9.0 },
        .target = { 1.0, 1.5, 0.0 },
        .up = { 0.0, 1.0, 0.0 },
        .ortho = 4.0,
        .outputs = SELVEDGE_DEPTH | SELVEDGE_FACE | SELVEDGE_UV | SELVEDGE_NORMAL | SELVEDGE_THICKNESS | SELVEDGE_EDGE
            | SELVEDGE_PART | SELVEDGE_INSTANCE,
    };
    SelvedgePicture* picture = NULL;
    WANT(OK, selvedge_render(renderer, model, &view, &picture), "");
    assert(selvedge_picture_clamps(picture) == 0 && selvedge_picture_clamps(NULL) == 0);
    SelvedgeImage image = { .struct_size = sizeof image };
    const size_t middle = 20 * 40 + 20, corner = 0;
#define VALUES(which, type, count, in)                                                    \
    WANT(OK, selvedge_picture_image(picture, which, &image), "");                         \
    assert(image.kind == in && image.channels == count && image.width == 40);             \
    const type* which##_values = image.data
    VALUES(SELVEDGE_DEPTH, float, 1, SELVEDGE_FLOAT32);
    assert(fabsf(SELVEDGE_DEPTH_values[middle] - 4.0f) < 1e-5f && isinf(SELVEDGE_DEPTH_values[corner]));
    VALUES(SELVEDGE_FACE, uint32_t, 1, SELVEDGE_UINT32);
    assert(SELVEDGE_FACE_values[middle] > 0 && SELVEDGE_FACE_values[corner] == 0);
    VALUES(SELVEDGE_UV, float, 2, SELVEDGE_FLOAT32);
    assert(SELVEDGE_UV_values[2 * middle] >= 0.0f && isnan(SELVEDGE_UV_values[2 * corner]));
    VALUES(SELVEDGE_NORMAL, float, 3, SELVEDGE_FLOAT32);
    assert(SELVEDGE_NORMAL_values[3 * middle + 2] > 0.999f && SELVEDGE_NORMAL_values[3 * corner + 2] == 0.0f);
    VALUES(SELVEDGE_THICKNESS, float, 1, SELVEDGE_FLOAT32);
    assert(fabsf(SELVEDGE_THICKNESS_values[middle] - 5.0f) < 1e-4f && SELVEDGE_THICKNESS_values[corner] == 0.0f);
    VALUES(SELVEDGE_EDGE, uint32_t, 1, SELVEDGE_UINT32);
    uint32_t most = 0;
    for (size_t i = 0; i < 1600; ++i) {
        most = SELVEDGE_EDGE_values[i] > most ? SELVEDGE_EDGE_values[i] : most;
    }
    assert(most > 0 && most <= 12 && SELVEDGE_EDGE_values[middle] == 0);
    VALUES(SELVEDGE_PART, uint32_t, 1, SELVEDGE_UINT32);
    assert(SELVEDGE_PART_values[middle] == 1 && SELVEDGE_PART_values[corner] == 0);
    VALUES(SELVEDGE_INSTANCE, uint32_t, 1, SELVEDGE_UINT32);
    assert(SELVEDGE_INSTANCE_values[middle] == 1);
    selvedge_picture_free(picture);
    return 0;
}

// The eye is 9 mm above the ground and sees only the block's top. OpenCV's formula says which pixels show it.
static int calibrated(const SelvedgeRenderer* renderer, const SelvedgeModel* model)
{
    const SelvedgeView view = {
        .struct_size = sizeof view,
        .width = 60,
        .height = 50,
        .intrinsics = { 40.0, 44.0, 12.25, 30.25 },
        .rotation = { 1, 0, 0, 0, -1, 0, 0, 0, -1 },
        .translation = { -1.0, 1.5, 9.0 },
        .outputs = SELVEDGE_DEPTH,
    };
    SelvedgePicture* picture = NULL;
    WANT(OK, selvedge_render(renderer, model, &view, &picture), "");
    SelvedgeImage image = { .struct_size = sizeof image };
    WANT(OK, selvedge_picture_image(picture, SELVEDGE_DEPTH, &image), "");
    const float* depth = image.data;
    for (int row = 0; row < 50; ++row) {
        for (int column = 0; column < 60; ++column) {
            // the top lies at z = 5, 4 mm from the eye: x from 0 to 2 and y from 0 to 3 there
            const double x = 1.0 + (column - 12.25) * 4.0 / 40.0, y = 1.5 - (row - 30.25) * 4.0 / 44.0;
            const int on_top = x > 0.0 && x < 2.0 && y > 0.0 && y < 3.0;
            assert((fabsf(depth[60 * row + column] - 4.0f) < 1e-5f) == on_top);
        }
    }
    selvedge_picture_free(picture);
    return 0;
}

// A picture beyond the device's memory: its colour alone takes 549 MiB.
static int little(const SelvedgeModel* model)
{
    const SelvedgeRendererOptions options = { .struct_size = sizeof options, .limit_bytes = 256u << 20 };
    SelvedgeRenderer* renderer = NULL;
    WANT(OK, selvedge_renderer_new(&options, &renderer), "");
    SelvedgePicture* picture = NULL;
    SelvedgeView view = { .struct_size = sizeof view, .width = 12000, .height = 12000 };
    WANT(RENDER, selvedge_render(renderer, model, &view, &picture), "are left of");
    assert(picture == NULL);
    view.width = view.height = 40;
    WANT(OK, selvedge_render(renderer, model, &view, &picture), "");
    selvedge_picture_free(picture);
    selvedge_renderer_free(renderer);
    return 0;
}

// The block is a mesh, and edges of meshes have no points to snap to: a STEP file is opened.
static int snaps(const char* path)
{
    SelvedgeModel* model = NULL;
    WANT(OK, selvedge_open(path, NULL, &model), "");
    SelvedgeView view = { .struct_size = sizeof view, .width = 200, .height = 150, .standard = "iso" };
    SelvedgeSnap snap = { .struct_size = sizeof snap };
    const uint32_t all = SELVEDGE_SNAP_VERTEX | SELVEDGE_SNAP_CENTRE | SELVEDGE_SNAP_EDGE;
    int vertices = 0;
    for (int at = 0; at < 200 * 150; at += 37) {
        const double x = at % 200 + 0.5, y = at / 200 + 0.5;
        WANT(OK, selvedge_model_snap(model, &view, x, y, 3.0, all, &snap), "");
        if (snap.kind != 0) {
            assert(hypot(snap.pixel[0] - x, snap.pixel[1] - y) <= 3.0 + 1e-9 && snap.edge > 0 && snap.instance == 1);
        }
        vertices += snap.kind == SELVEDGE_SNAP_VERTEX;
    }
    assert(vertices > 0);
    WANT(OK, selvedge_model_snap(model, &view, 1.0, 1.0, 3.0, all, &snap), "");
    assert(snap.kind == 0 && snap.edge == 0);
    WANT(ARGUMENT, selvedge_model_snap(model, &view, 1.0, 1.0, 0.0, all, &snap), "radius");
    WANT(ARGUMENT, selvedge_model_snap(model, &view, NAN, 1.0, 3.0, all, &snap), "two numbers");
    WANT(ARGUMENT, selvedge_model_snap(model, &view, 1.0, 1.0, 3.0, 8, &snap), "no choice");
    WANT(ARGUMENT, selvedge_model_snap(model, &view, 1.0, 1.0, 3.0, 0, &snap), "no choice");
    WANT(ARGUMENT, selvedge_model_snap(model, &view, 1.0, 1.0, 3.0, all, NULL), "null pointer");
    WANT(ARGUMENT, selvedge_model_snap(NULL, &view, 1.0, 1.0, 3.0, all, &snap), "model is a null pointer");
    selvedge_model_free(model);
    return 0;
}

int main(int count, char** arguments)
{
    assert(count == 2);
    if (files()) {
        return 1;
    }
    SelvedgeRenderer* renderer = NULL;
    SelvedgeRendererOptions named = { .struct_size = sizeof named, .device = "no such device" };
    WANT(SELVEDGE_STATUS_DEVICE, selvedge_renderer_new(&named, &renderer), "no such device");
    assert(renderer == NULL);
    WANT(ARGUMENT, selvedge_renderer_new(NULL, NULL), "null pointer");
    WANT(OK, selvedge_renderer_new(NULL, &renderer), "");
    SelvedgeModel* model = NULL;
    WANT(OK, selvedge_open_bytes(BLOCK, sizeof BLOCK - 1, "block.obj", NULL, &model), "");
    int bad = snaps(arguments[1]) || views(renderer, model) || images(renderer, model) || calibrated(renderer, model)
        || little(model);
    selvedge_model_free(model);
    selvedge_renderer_free(renderer);
    selvedge_renderer_free(NULL);
    assert(strcmp(selvedge_version(), SELVEDGE_TEST_VERSION) == 0);
    return bad;
}
