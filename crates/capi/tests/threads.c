// Two threads use one renderer at once, each with a model and a last error of its own. Pictures and models outlive the
// renderer that drew them.

#include <assert.h>
#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <string.h>

#include <selvedge.h>

enum { WIDTH = 48, HEIGHT = 32, PIXELS = WIDTH * HEIGHT, TIMES = 6 };

typedef struct {
    const SelvedgeRenderer* renderer;
    SelvedgeModel* model;
    const char* missing; // a file that does not exist
    float depth[PIXELS];
} Work;

static SelvedgePicture* drawn(const SelvedgeRenderer* renderer, const SelvedgeModel* model)
{
    const SelvedgeView view = {
        .struct_size = sizeof view, .width = WIDTH, .height = HEIGHT, .standard = "iso", .outputs = SELVEDGE_DEPTH
    };
    SelvedgePicture* picture = NULL;
    if (selvedge_render(renderer, model, &view, &picture) != SELVEDGE_STATUS_OK) {
        fprintf(stderr, "%s\n", selvedge_last_error());
    }
    return picture;
}

static int has_depth(const SelvedgePicture* picture, const float* expected)
{
    SelvedgeImage image = { .struct_size = sizeof image };
    return selvedge_picture_image(picture, SELVEDGE_DEPTH, &image) == SELVEDGE_STATUS_OK
        && memcmp(image.data, expected, PIXELS * sizeof(float)) == 0;
}

static void* draw(void* with)
{
    Work* work = with;
    for (int i = 0; i < TIMES; ++i) {
        SelvedgePicture* picture = drawn(work->renderer, work->model);
        const int is_right = picture != NULL && has_depth(picture, work->depth);
        selvedge_picture_free(picture);
        SelvedgeModel* none = NULL;
        const SelvedgeStatus status = selvedge_open(work->missing, NULL, &none);
        sched_yield();
        if (!is_right || status != SELVEDGE_STATUS_FILE || strstr(selvedge_last_error(), work->missing) == NULL) {
            return "a picture or an error is another thread's";
        }
    }
    return NULL;
}

int main(void)
{
    static Work work[2] = { { .missing = "first/none.step" }, { .missing = "second/none.step" } };
    static const char* const solids[2] = { "sphere(4);", "cube([2, 3, 5]);" };
    SelvedgeRenderer* renderer = NULL;
    assert(selvedge_renderer_new(NULL, &renderer) == SELVEDGE_STATUS_OK);
    SelvedgePicture* kept[2];
    for (int i = 0; i < 2; ++i) {
        work[i].renderer = renderer;
        const SelvedgeStatus read = selvedge_open_bytes(solids[i], strlen(solids[i]), "a.csg", NULL, &work[i].model);
        assert(read == SELVEDGE_STATUS_OK);
        kept[i] = drawn(renderer, work[i].model);
        SelvedgeImage image = { .struct_size = sizeof image };
        assert(selvedge_picture_image(kept[i], SELVEDGE_DEPTH, &image) == SELVEDGE_STATUS_OK);
        memcpy(work[i].depth, image.data, sizeof work[i].depth);
    }
    assert(memcmp(work[0].depth, work[1].depth, sizeof work[0].depth) != 0);

    pthread_t threads[2];
    for (int i = 0; i < 2; ++i) {
        assert(pthread_create(&threads[i], NULL, draw, &work[i]) == 0);
    }
    const char* wrong = NULL;
    for (int i = 0; i < 2; ++i) {
        void* ended = NULL;
        assert(pthread_join(threads[i], &ended) == 0);
        wrong = ended != NULL ? ended : wrong;
    }

    selvedge_renderer_free(renderer);
    SelvedgeRenderer* other = NULL;
    assert(selvedge_renderer_new(NULL, &other) == SELVEDGE_STATUS_OK);
    for (int i = 0; i < 2; ++i) {
        assert(has_depth(kept[i], work[i].depth));
        SelvedgePicture* again = drawn(other, work[i].model);
        assert(again != NULL && has_depth(again, work[i].depth));
        selvedge_picture_free(again);
        selvedge_model_free(work[i].model);
    }
    selvedge_renderer_free(other);
    for (int i = 0; i < 2; ++i) {
        assert(has_depth(kept[i], work[i].depth));
        selvedge_picture_free(kept[i]);
    }
    if (wrong != NULL) {
        fprintf(stderr, "%s\n", wrong);
    }
    return wrong != NULL;
}
