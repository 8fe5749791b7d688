// CAD files to exact pictures, depths, normals and face numbers: libselvedge_c. docs/c.md has the tour.
//
// Made by cbindgen from crates/capi: SELVEDGE_WRITE_HEADER=1 cargo test -p selvedge-capi writes it.

#ifndef SELVEDGE_H
#define SELVEDGE_H

#include <stddef.h>
#include <stdint.h>

// sRGB and opacity, 4 bytes a pixel; every picture has it.
#define SELVEDGE_COLOUR (1 << 0)

// Distance along the view axis, millimetres, one float a pixel; +infinity is background.
#define SELVEDGE_DEPTH (1 << 1)

// Number of the face in the file, one uint32_t a pixel; 0 is background.
#define SELVEDGE_FACE (1 << 2)

// Parameters in the face's domain, two floats a pixel; NaN is background.
#define SELVEDGE_UV (1 << 3)

// Unit outward normal in model axes, three floats a pixel; 0 is background.
#define SELVEDGE_NORMAL (1 << 4)

// Length of the ray within solids and closed parts, millimetres, one float a pixel.
#define SELVEDGE_THICKNESS (1 << 5)

// Number of the edge whose line covers the pixel, one uint32_t a pixel; 0 is none, 4294967295 the outline of a curved face,
// 4294967294 a line of a Boolean solid. The colour shows the lines, too.
#define SELVEDGE_EDGE (1 << 6)

// Index of the part, plus 1, one uint32_t a pixel; 0 is none.
#define SELVEDGE_PART (1 << 7)

// Index of the instance, plus 1, one uint32_t a pixel; 0 is none.
#define SELVEDGE_INSTANCE (1 << 8)

// uint8_t
#define SELVEDGE_UINT8 1

// uint32_t
#define SELVEDGE_UINT32 2

// float
#define SELVEDGE_FLOAT32 3

// An edge's end.
#define SELVEDGE_SNAP_VERTEX 1

// The centre of a round edge.
#define SELVEDGE_SNAP_CENTRE 2

// A point on an edge.
#define SELVEDGE_SNAP_EDGE 4

// How a call ended.
typedef enum SelvedgeStatus {
    // The call succeeded.
    SELVEDGE_STATUS_OK = 0,
    // A pointer, size, number or name that cannot be used.
    SELVEDGE_STATUS_ARGUMENT = 1,
    // A file cannot be read or written, or nothing of it can be drawn.
    SELVEDGE_STATUS_FILE = 2,
    // There is no usable Vulkan device.
    SELVEDGE_STATUS_DEVICE = 3,
    // The model cannot be drawn so, or the device failed.
    SELVEDGE_STATUS_RENDER = 4,
    // A defect of the library.
    SELVEDGE_STATUS_INTERNAL = 5,
} SelvedgeStatus;

// A renderer on the host's device. Calls of several threads follow each other.
typedef struct SelvedgeHost SelvedgeHost;

// A model. Free it with selvedge_model_free; renderers and pictures do not need it any more then.
typedef struct SelvedgeModel SelvedgeModel;

// A finished picture.
typedef struct SelvedgePicture SelvedgePicture;

// A device that draws. Several threads may use one: it draws their pictures in turn.
typedef struct SelvedgeRenderer SelvedgeRenderer;

// vkGetInstanceProcAddr.
typedef void (*(*SelvedgeGetInstanceProcAddr)(void *instance, const char *name))(void);

// A Vulkan device of the host's. All of it outlives the SelvedgeHost.
typedef struct SelvedgeVulkan {
    // sizeof(SelvedgeVulkan)
    size_t struct_size;
    // vkGetInstanceProcAddr of the loader.
    SelvedgeGetInstanceProcAddr get_instance_proc_addr;
    // VkInstance, made for Vulkan 1.3.
    void *instance;
    // VkPhysicalDevice that selvedge_vulkan_missing accepts.
    void *physical_device;
    // VkDevice with the features that selvedge_vulkan_features sets, and the extension VK_KHR_push_descriptor.
    void *device;
    // Queue family of the host's command buffers. It supports graphics and compute.
    uint32_t queue_family;
    // Frames in flight; 0: 2.
    uint32_t slots;
    // VkFormat of the colour target.
    uint32_t colour_format;
    // VkFormat of a depth target of the host's, reversed: 1 near, 0 far. 0: there is none.
    uint32_t depth_format;
    // Images beside the colour: SELVEDGE_DEPTH | SELVEDGE_NORMAL and so on. With SELVEDGE_THICKNESS rays are followed
    // through all solids, and closed parts stay as they were uploaded.
    uint32_t outputs;
    // Most bytes of buffers and images on the device; 0: what its heaps have left, which bounds them in any case.
    uint64_t limit_bytes;
    // VkPipelineCache with which all pipelines are made; 0: none. It outlives the SelvedgeHost, and meanwhile the host
    // does not merge into it.
    uint64_t pipeline_cache;
} SelvedgeVulkan;

// A picture to be drawn. Zeros and null are the defaults, but for width and height.
typedef struct SelvedgeView {
    // sizeof(SelvedgeView)
    size_t struct_size;
    // Pixels, 1 to 16384.
    uint32_t width;
    // Pixels, 1 to 16384.
    uint32_t height;
    // iso, front, right, back, left, top, bottom, or "AZIMUTH,ELEVATION" in degrees: the model fills the picture. Null:
    // iso, or from `eye` where eye and target differ.
    const char *standard;
    // Position of the eye, millimetres.
    double eye[3];
    // Point that the eye looks at.
    double target[3];
    // Direction that points up in the picture; zeros: 0, 0, 1.
    double up[3];
    // Vertical field of view from `eye`, degrees; 0: 35.
    double fov;
    // Not 0: a parallel view from `eye`; the height of the picture in millimetres.
    double ortho;
    // Images beside the colour: SELVEDGE_DEPTH | SELVEDGE_NORMAL and so on.
    uint32_t outputs;
    // 1, 4 or 8 samples of each pixel's colour; 0: 1.
    uint32_t samples;
    // shaded, clay, technical, normals, zebra, isophotes, mean-curvature or gaussian-curvature; null: shaded.
    const char *style;
    // A CSS colour, gradient or none; null: gradient.
    const char *background;
    // Lines along edges: all, sharp or none; null: none, and all where SELVEDGE_EDGE is among the outputs.
    const char *edges;
    // Width of lines in pixels; 0: 1 or more, and more in high pictures.
    double line_width;
    // Direction towards a sun that casts shadows; zeros: a studio's light.
    double sun[3];
    // Largest distance in pixels between a drawn boundary and the true one, at least 0.1; 0: 0.5.
    double tolerance;
    // A calibrated camera in place of `standard` and `eye`, by OpenCV's conventions: fx, fy, cx, cy in pixels of this
    // picture. The first pixel's centre is 0, 0. Zeros: the camera is not calibrated.
    double intrinsics[4];
    // The calibrated camera's rotation from model to camera axes (x right, y down, z ahead), row by row; zeros: the
    // identity.
    double rotation[9];
    // The model's origin in the calibrated camera's axes, millimetres: a point X is seen at K (R X + t).
    double translation[3];
    // Radius of ambient occlusion, millimetres. 0: a twenty-fifth of the model's diagonal with one sample, no ambient
    // occlusion with several. Below 0: no ambient occlusion.
    double ambient;
    // The largest mean curvature on the scale of the styles of curvature, 1/mm, whose square is that of Gaussian curvature;
    // 0: a round number at which most of the model's curvatures are told apart.
    double curvature_range;
} SelvedgeView;

// An image of the host's; 0 where there is none.
typedef struct SelvedgeTarget {
    // VkImage with one level and one layer.
    uint64_t image;
    // VkImageView of all of it.
    uint64_t view;
} SelvedgeTarget;

// The host's images of one frame, all of one size. Before and after the frame, colour images are in layout
// COLOR_ATTACHMENT_OPTIMAL and the depth target is in DEPTH_STENCIL_ATTACHMENT_OPTIMAL. The host's barriers order its
// earlier work before reads and writes of these attachments, and its later work after them.
typedef struct SelvedgeTargets {
    // sizeof(SelvedgeTargets)
    size_t struct_size;
    // Width of the images, pixels; if width and height are 0, the images have the size of the view. Larger images get
    // the picture in a rectangle. They need the usage TRANSFER_DST, and TRANSFER_SRC if the view has no background.
    uint32_t width;
    // Height of the images, pixels.
    uint32_t height;
    // Column of the images at which the picture's upper left pixel goes.
    uint32_t x;
    // Row of the images at which the picture's upper left pixel goes.
    uint32_t y;
    // Of the format that the host gave.
    struct SelvedgeTarget colour;
    // Of the depth format that the host gave.
    struct SelvedgeTarget depth_buffer;
    // R32_SFLOAT: distance along the view axis, infinite for background.
    struct SelvedgeTarget depth;
    // R32_UINT.
    struct SelvedgeTarget face;
    // R32G32_SFLOAT.
    struct SelvedgeTarget uv;
    // R32G32B32A32_SFLOAT.
    struct SelvedgeTarget normal;
    // R32_UINT.
    struct SelvedgeTarget edge;
    // R32_UINT.
    struct SelvedgeTarget part;
    // R32_UINT.
    struct SelvedgeTarget instance;
    // R32_SFLOAT. A frame may leave it out.
    struct SelvedgeTarget thickness;
} SelvedgeTargets;

// The counts of a finished frame.
typedef struct SelvedgeReport {
    // sizeof(SelvedgeReport)
    size_t struct_size;
    // 1: a frame was recorded into the slot.
    uint32_t recorded;
    // 1: the frame is whole. 0: a list was too short, and the next frame recorded into the slot has room for all of it; or
    // a part of a large model was copied first, and the next frames copy the rest.
    uint32_t complete;
    // Places where the frame could not keep the promise of accuracy.
    uint64_t clamps;
} SelvedgeReport;

// What a frame shows at a pixel. Numbers are those of the images, counted from 1; 0 is none.
typedef struct SelvedgeHit {
    // sizeof(SelvedgeHit)
    size_t struct_size;
    // Number in the image of faces. 0: the pixel shows no model, or no pixel was read back; the other fields are 0.
    uint32_t face;
    // Number of the part; 0 for Boolean solids.
    uint32_t part;
    // Number of the instance; 0 for Boolean solids.
    uint32_t instance;
    // Number of the edge, among those of the part, whose line covers the pixel; 0 without one.
    uint32_t edge_of_part;
    // Parameters in the face's domain; of a triangle, the weights of its second and third corner.
    double uv[2];
    // Millimetres.
    double point[3];
    // Unit outward normal in model axes; zeros where there is none.
    double normal[3];
    // Distance from the eye along the view axis, millimetres.
    double depth;
} SelvedgeHit;

// How to read. Zeros are the defaults.
typedef struct SelvedgeReadOptions {
    // sizeof(SelvedgeReadOptions)
    size_t struct_size;
    // Most bytes of a file, gzip undone; 0: three quarters of the machine's memory.
    uint64_t limit_bytes;
    // If this is not 0, a file fails with SELVEDGE_STATUS_FILE when anything of it is left out.
    uint32_t strict;
    // Most seconds for reading a file, beyond which it fails with SELVEDGE_STATUS_FILE; 0: no limit.
    double limit_s;
} SelvedgeReadOptions;

// Counts and extent of a model.
typedef struct SelvedgeModelInfo {
    // sizeof(SelvedgeModelInfo)
    size_t struct_size;
    // Smallest coordinates, millimetres.
    double low[3];
    // Largest coordinates.
    double high[3];
    // Distinct bodies; images of parts count them from 1.
    uint64_t parts;
    // Placed bodies; images of instances count them from 1.
    uint64_t instances;
    // Distinct faces.
    uint64_t faces;
    // See selvedge_model_warning.
    uint64_t warnings;
    // 1: nothing of the file is left out.
    uint32_t complete;
    // The drawn and the missing parts, one sentence; lives as long as the model.
    const char *summary;
} SelvedgeModelInfo;

// Something in the file that was left out, repaired or guessed.
typedef struct SelvedgeWarning {
    // sizeof(SelvedgeWarning)
    size_t struct_size;
    // The file; lives as long as the model, as does the message.
    const char *file;
    // The fault, and what was done about it.
    const char *message;
    // Counted from 1; 0 for the file as a whole.
    uint64_t line;
    // Number of the entity, of STEP's #123 it is 123; 0 for none.
    uint32_t entity;
    // How many occurrences this one stands for.
    uint64_t count;
} SelvedgeWarning;

// An image of a picture: rows without gaps, the first on top, the channels of a pixel together.
typedef struct SelvedgeImage {
    // sizeof(SelvedgeImage)
    size_t struct_size;
    // width x height x channels numbers; lives as long as the picture.
    const void *data;
    // SELVEDGE_UINT8, SELVEDGE_UINT32 or SELVEDGE_FLOAT32.
    uint32_t kind;
    // Numbers a pixel.
    uint32_t channels;
    // Pixels.
    uint32_t width;
    // Pixels.
    uint32_t height;
} SelvedgeImage;

// Which device. Zeros are the defaults.
typedef struct SelvedgeRendererOptions {
    // sizeof(SelvedgeRendererOptions)
    size_t struct_size;
    // Part of the device's name; null takes a discrete GPU, else an integrated one, else the CPU. Of several devices it
    // is the first, and with "#1" behind it the second: "#1" alone is the second of all.
    const char *device;
    // Not 0: load Vulkan's validation layer; its messages about a picture give SELVEDGE_STATUS_RENDER.
    uint32_t validation;
    // Most bytes of buffers and images on the device, beyond which a picture gives SELVEDGE_STATUS_RENDER; 0: as many
    // as the device has left.
    uint64_t limit_bytes;
} SelvedgeRendererOptions;

// A point of a model near a place in a picture.
typedef struct SelvedgeSnap {
    // sizeof(SelvedgeSnap)
    size_t struct_size;
    // SELVEDGE_SNAP_VERTEX, SELVEDGE_SNAP_CENTRE or SELVEDGE_SNAP_EDGE; 0: no point was found, and the other fields
    // are 0.
    uint32_t kind;
    // Number of the edge, as in the image of edges; for a vertex, the number of an edge that ends there.
    uint32_t edge;
    // Number of the placed body, as in the image of instances.
    uint32_t instance;
    // Millimetres.
    double point[3];
    // Position in the picture, pixels from the upper left corner; the first pixel's centre is 0.5, 0.5.
    double pixel[2];
    // Distance from the given place, pixels.
    double distance_px;
    // Distance from the eye along the view axis, millimetres.
    double depth;
} SelvedgeSnap;



#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// One sentence about the last call of this thread that returned a status: it names file and line or entity. Empty after
// SELVEDGE_STATUS_OK. Valid until the next such call of this thread.
const char *selvedge_last_error(void);

// The library's version, as in "0.1.0".
const char *selvedge_version(void);

// Checks a physical device. If it lacks something, the status is SELVEDGE_STATUS_DEVICE and selvedge_last_error lists
// what is missing. Only the function, the instance and the physical device of `vulkan` are read.
//
// # Safety
// The handles are alive.
enum SelvedgeStatus selvedge_vulkan_missing(const struct SelvedgeVulkan *vulkan);

// Sets the features that the device must have, and leaves the others: VkPhysicalDeviceFeatures,
// VkPhysicalDeviceVulkan12Features and VkPhysicalDeviceVulkan13Features, whose sType and pNext the host sets.
//
// # Safety
// Pointers to these structs, or null.
enum SelvedgeStatus selvedge_vulkan_features(void *core, void *vulkan12, void *vulkan13);

// Makes a renderer on the host's device. The host keeps the device.
//
// # Safety
// Pointers are null or point to what they say; the handles are alive until the SelvedgeHost is freed.
enum SelvedgeStatus selvedge_host_new(const struct SelvedgeVulkan *vulkan, struct SelvedgeHost **host);

// Uploads the model that later frames show. Only samples, edges, line_width, ambient and sun of `view` are read,
// whether its style shows curvature, and with edges its height: line_width counts pixels of a picture so high. The call
// does not wait for the GPU: objects that frames in flight use are freed with their slots.
//
// # Safety
// Pointers are null or point to what they say.
enum SelvedgeStatus selvedge_host_upload(const struct SelvedgeHost *host,
                                         const struct SelvedgeModel *model,
                                         const struct SelvedgeView *view);

// Records a frame into a VkCommandBuffer of the host's. Only size, camera, style, curvature_range (which a host sets:
// where it is 0, the whole model is sampled), background and tolerance of `view` are read. With a null background the
// host's picture stays where no model is drawn. A standard view shows all of the scene as it is then. The frame that was
// recorded into the slot before has finished.
//
// # Safety
// Pointers are null or point to what they say. `commands` is recording, outside rendering, on the host's queue family,
// and is submitted once. Frames are submitted in the order in which they are recorded. After SELVEDGE_STATUS_RENDER
// the host resets `commands`.
enum SelvedgeStatus selvedge_host_record(const struct SelvedgeHost *host,
                                         void *commands,
                                         uint32_t slot,
                                         const struct SelvedgeView *view,
                                         const struct SelvedgeTargets *targets);

// Fills `report`, whose struct_size is set, with the counts of the frame that was recorded last into the slot. That
// frame has finished.
//
// # Safety
// Pointers are null or point to what they say.
enum SelvedgeStatus selvedge_host_report(const struct SelvedgeHost *host, uint32_t slot, struct SelvedgeReport *report);

// Frees the renderer, and leaves the host's device as it is; null is allowed. The GPU has finished all frames.
//
// # Safety
// This library made it, and no other call uses it at the same time.
void selvedge_host_free(struct SelvedgeHost *host);

// Moves an instance, counted from 0. `columns` takes part to model coordinates: the columns x, y, z and the
// translation, millimetres; finite, not flat, with factors of lengths from 1e-30 to 1e30. The next frame shows the new
// place; the model is not uploaded again.
//
// # Safety
// Pointers are null or point to what they say; `columns` to 12 numbers.
enum SelvedgeStatus selvedge_host_set_transform(const struct SelvedgeHost *host,
                                                uint64_t instance,
                                                const double *columns);

// Shows (not 0) or hides an instance, counted from 0.
//
// # Safety
// The pointer is null or points to a value of its type.
enum SelvedgeStatus selvedge_host_set_visible(const struct SelvedgeHost *host, uint64_t instance, uint32_t visible);

// Gives an instance, counted from 0, a colour in place of those of its faces: red, green, blue and opacity, from 0 to 1
// in linear light. The opacity must be 1. Null: the colours of its faces.
//
// # Safety
// Pointers are null or point to what they say; `colour` to 4 numbers.
enum SelvedgeStatus selvedge_host_set_colour(const struct SelvedgeHost *host, uint64_t instance, const float *colour);

// Marks an instance, counted from 0, by a colour over its own, as strong as its opacity; numbers as in
// selvedge_host_set_colour. Null: no mark.
//
// # Safety
// Pointers are null or point to what they say; `colour` to 4 numbers.
enum SelvedgeStatus selvedge_host_set_selected(const struct SelvedgeHost *host, uint64_t instance, const float *colour);

// Adds a model to the uploaded one, without an upload of the rest where the scene allows that: docs/embedding.md. The
// next frame shows it. `added` gets its number, above 0. Frames in flight draw the scene as it was; nothing waits.
//
// # Safety
// Pointers are null or point to what they say.
enum SelvedgeStatus selvedge_host_add(const struct SelvedgeHost *host,
                                      const struct SelvedgeModel *model,
                                      uint64_t *added);

// Removes a model that was added; the next frame does not show it. The instances of others keep their numbers.
//
// # Safety
// The pointer is null or points to a value of its type.
enum SelvedgeStatus selvedge_host_remove(const struct SelvedgeHost *host, uint64_t added);

// Says which instances are those of an added model: `count` of them from `first` on, counted from 0.
//
// # Safety
// Pointers are null or point to what they say.
enum SelvedgeStatus selvedge_host_instances(const struct SelvedgeHost *host,
                                            uint64_t added,
                                            uint64_t *first,
                                            uint64_t *count);

// Lets the next frame recorded read back what it shows at a pixel: column and row, from the upper left corner of the
// picture. The last call before the frame counts.
//
// # Safety
// The pointer is null or points to a value of its type.
enum SelvedgeStatus selvedge_host_pick(const struct SelvedgeHost *host, uint32_t x, uint32_t y);

// Fills `hit`, whose struct_size is set, with what the frame recorded last into the slot shows at the pixel of
// selvedge_host_pick. That frame has finished.
//
// # Safety
// Pointers are null or point to what they say.
enum SelvedgeStatus selvedge_host_picked(const struct SelvedgeHost *host, uint32_t slot, struct SelvedgeHit *hit);

// The frame recorded last, into this slot, never reached the GPU: the host reset its command buffer, or the submission
// failed. The next frame copies again what it would have copied.
//
// # Safety
// The pointer is null or points to a value of its type.
enum SelvedgeStatus selvedge_host_discard(const struct SelvedgeHost *host, uint32_t slot);

// A call of the host's own returned VK_ERROR_DEVICE_LOST: from now on frames are refused with SELVEDGE_STATUS_RENDER,
// and selvedge_host_free frees handles alone.
//
// # Safety
// The pointer is null or points to a value of its type.
enum SelvedgeStatus selvedge_host_device_lost(const struct SelvedgeHost *host);

// Reads a file: STEP, IGES, OBJ, STL, 3MF, AMF, PLY, OFF, glTF, Rhino .3dm, .csg and others, by its content. `options`
// may be null.
//
// # Safety
// Pointers are null or point to what they say.
enum SelvedgeStatus selvedge_open(const char *path,
                                  const struct SelvedgeReadOptions *options,
                                  struct SelvedgeModel **model);

// The same of a file's content. `name` is its name in messages, and the name's ending gives the format where the
// content does not.
//
// # Safety
// Pointers are null or point to what they say; `bytes` to `count` bytes.
enum SelvedgeStatus selvedge_open_bytes(const void *bytes,
                                        size_t count,
                                        const char *name,
                                        const struct SelvedgeReadOptions *options,
                                        struct SelvedgeModel **model);

// Fills `info`, whose struct_size is set.
//
// # Safety
// Pointers are null or point to what they say.
enum SelvedgeStatus selvedge_model_info(const struct SelvedgeModel *model, struct SelvedgeModelInfo *info);

// Fills `warning`, whose struct_size is set, with the one of this index, counted from 0.
//
// # Safety
// Pointers are null or point to what they say.
enum SelvedgeStatus selvedge_model_warning(const struct SelvedgeModel *model,
                                           uint64_t index,
                                           struct SelvedgeWarning *warning);

// Frees a model; null is allowed.
//
// # Safety
// This library made it, and no other call uses it at the same time.
void selvedge_model_free(struct SelvedgeModel *model);

// Fills `image`, whose struct_size is set, with the one of this flag: SELVEDGE_COLOUR, or one of the view's outputs.
//
// # Safety
// Pointers are null or point to what they say.
enum SelvedgeStatus selvedge_picture_image(const struct SelvedgePicture *picture,
                                           uint32_t which,
                                           struct SelvedgeImage *image);

// Places where the frame could not keep the promise of accuracy; 0 in a good picture, and for null.
//
// # Safety
// Null, or a picture.
uint64_t selvedge_picture_clamps(const struct SelvedgePicture *picture);

// Writes the colour as a PNG file.
//
// # Safety
// Pointers are null or point to what they say.
enum SelvedgeStatus selvedge_picture_save_png(const struct SelvedgePicture *picture, const char *path);

// Frees a picture and its images; null is allowed.
//
// # Safety
// This library made it, and no other call uses it at the same time.
void selvedge_picture_free(struct SelvedgePicture *picture);

// Opens a device; `options` may be null.
//
// # Safety
// Pointers are null or point to what they say.
enum SelvedgeStatus selvedge_renderer_new(const struct SelvedgeRendererOptions *options,
                                          struct SelvedgeRenderer **renderer);

// Draws a picture and waits for it. A model that was drawn by the call before is not prepared again.
//
// # Safety
// Pointers are null or point to what they say.
enum SelvedgeStatus selvedge_render(const struct SelvedgeRenderer *renderer,
                                    const struct SelvedgeModel *model,
                                    const struct SelvedgeView *view,
                                    struct SelvedgePicture **picture);

// Frees the device; null is allowed.
//
// # Safety
// This library made it, and no other call uses it at the same time.
void selvedge_renderer_free(struct SelvedgeRenderer *renderer);

// Finds a visible point of the model within `radius` pixels of a place in the view's picture, and fills `snap`, whose
// struct_size is set. `kinds`: SELVEDGE_SNAP_VERTEX | SELVEDGE_SNAP_CENTRE | SELVEDGE_SNAP_EDGE. A vertex is preferred
// to a centre, and both to an edge; within a kind the nearest point is taken. An edge offers only its point nearest to
// the place. Only size and camera of the view are read. The search uses double precision and no device.
//
// # Safety
// Pointers are null or point to what they say.
enum SelvedgeStatus selvedge_model_snap(const struct SelvedgeModel *model,
                                        const struct SelvedgeView *view,
                                        double x,
                                        double y,
                                        double radius,
                                        uint32_t kinds,
                                        struct SelvedgeSnap *snap);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SELVEDGE_H */
