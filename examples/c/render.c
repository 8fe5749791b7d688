// Draws a CAD file to a PNG file and tells how far away the nearest point is that the picture shows.
//
//     cc -std=c11 render.c $(pkg-config --cflags --libs selvedge) -lm -o render
//     ./render part.step part.png 640 480

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <selvedge.h>

static int failed(const char* what)
{
    fprintf(stderr, "%s: %s\n", what, selvedge_last_error());
    return 1;
}

static int draw(SelvedgeRenderer* renderer, const SelvedgeModel* model, const char* path, uint32_t width, uint32_t height)
{
    const SelvedgeView view = {
        .struct_size = sizeof view,
        .width = width,
        .height = height,
        .standard = "iso",
        .outputs = SELVEDGE_DEPTH | SELVEDGE_FACE,
    };
    SelvedgePicture* picture = NULL;
    if (selvedge_render(renderer, model, &view, &picture) != SELVEDGE_STATUS_OK) {
        return failed("render");
    }
    SelvedgeImage depth = { .struct_size = sizeof depth };
    int bad = selvedge_picture_image(picture, SELVEDGE_DEPTH, &depth) != SELVEDGE_STATUS_OK
        || selvedge_picture_save_png(picture, path) != SELVEDGE_STATUS_OK;
    if (bad) {
        failed("picture");
    } else {
        const float* values = depth.data;
        float nearest = INFINITY;
        size_t seen = 0;
        for (size_t i = 0; i < (size_t)depth.width * depth.height; ++i) {
            seen += isfinite(values[i]) != 0;
            nearest = fminf(nearest, values[i]);
        }
        printf("%zu of %zu pixels, nearest at %.3f mm\n", seen, (size_t)depth.width * depth.height, (double)nearest);
    }
    selvedge_picture_free(picture);
    return bad;
}

int main(int count, char** arguments)
{
    if (count != 5) {
        fprintf(stderr, "usage: %s FILE OUT.png WIDTH HEIGHT\n", arguments[0]);
        return 2;
    }
    SelvedgeModel* model = NULL;
    if (selvedge_open(arguments[1], NULL, &model) != SELVEDGE_STATUS_OK) {
        return failed("open");
    }
    SelvedgeModelInfo info = { .struct_size = sizeof info };
    selvedge_model_info(model, &info);
    printf("%s\n", info.summary);
    for (uint64_t i = 0; i < info.warnings; ++i) {
        SelvedgeWarning warning = { .struct_size = sizeof warning };
        if (selvedge_model_warning(model, i, &warning) == SELVEDGE_STATUS_OK) {
            fprintf(stderr, "%s:%llu: %s\n", warning.file, (unsigned long long)warning.line, warning.message);
        }
    }
    SelvedgeRenderer* renderer = NULL;
    int bad = selvedge_renderer_new(NULL, &renderer) != SELVEDGE_STATUS_OK;
    if (bad) {
        failed("device");
    } else {
        bad = draw(renderer, model, arguments[2], (uint32_t)atoi(arguments[3]), (uint32_t)atoi(arguments[4]));
    }
    selvedge_renderer_free(renderer);
    selvedge_model_free(model);
    return bad;
}
