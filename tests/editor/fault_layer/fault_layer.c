// A Vulkan layer that makes things go wrong: the n-th call of one kind returns an error of choice.
//
// A driver loses its device about once in a lifetime, and never while a test watches. With this layer between the
// program and any driver, it happens on demand. Set by the environment:
//
//   FAULT_CALL    submit | wait | acquire | present | allocate | device (creating one)
//   FAULT_RESULT  the VkResult to return, as a number: -4 device lost, -2 no device memory, -1000000000 surface lost …
//   FAULT_AT      the n-th call fails, counted from 1
//   FAULT_CLIMB   1: calls are counted for each device; the first device fails at call n, the next one that was
//                 used at call n + 1, and so on: every n in one run
//   FAULT_EVERY   k: after that every k-th call fails too; 0 (default): only one call fails
//   FAULT_SPARES  m: of every m calls the first succeeds; 0 (default): none is spared
//   FAULT_TIMES   maximum number of faults (default: 1, or no maximum where FAULT_EVERY is set)
//   FAULT_LOG     a file; a line "call n result" is added for each fault
//   FAULT_READS   milliseconds for which, after each frame, a thread reads (before any other thread) what comes over
//                 the surface's connection to the X server, as real drivers do where they wait for their own events
//
// As with a real driver, a lost device stays lost: every later call on it except an allocation reports that.

#define _GNU_SOURCE
#include <dlfcn.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

enum call { SUBMIT, WAIT, ACQUIRE, PRESENT, ALLOCATE, DEVICE, CALLS };
static const char *const names[CALLS] = {"submit", "wait", "acquire", "present", "allocate", "device"};

static struct {
    int call, result, at, climb, every, spares, times, reads;
    const char *log;
} wanted;

struct device {
    void *key; // what the loader stores in every handle of this device; null: a free slot
    int lost;
    long calls;
    PFN_vkGetDeviceProcAddr next;
    PFN_vkDestroyDevice DestroyDevice;
    PFN_vkQueueSubmit QueueSubmit;
    PFN_vkQueueSubmit2 QueueSubmit2;
    PFN_vkWaitSemaphores WaitSemaphores;
    PFN_vkWaitForFences WaitForFences;
    PFN_vkAllocateMemory AllocateMemory;
    PFN_vkAcquireNextImageKHR AcquireNextImageKHR;
    PFN_vkQueuePresentKHR QueuePresentKHR;
};

// One test process creates hundreds of devices, one after the other; a slot is reused when its device is destroyed.
static struct device devices[64];
struct surface_info;
typedef VkResult(VKAPI_PTR *surface_maker)(VkInstance, const struct surface_info *, const VkAllocationCallbacks *, VkSurfaceKHR *);
static struct instance {
    void *key;
    PFN_vkGetInstanceProcAddr next;
    surface_maker of_xlib, of_xcb;
    PFN_vkDestroySurfaceKHR unmake;
} instances[64];
static long calls;  // of all devices
static int faults;  // so far
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static int number(const char *name, int usual) {
    const char *text = getenv(name);
    return text && *text ? atoi(text) : usual;
}

static void read_wishes(void) {
    const char *call = getenv("FAULT_CALL");
    wanted.call = -1;
    for (int index = 0; call && index < CALLS; index++)
        if (!strcmp(call, names[index])) wanted.call = index;
    wanted.result = number("FAULT_RESULT", VK_ERROR_DEVICE_LOST);
    wanted.at = number("FAULT_AT", 1);
    wanted.climb = number("FAULT_CLIMB", 0);
    wanted.every = number("FAULT_EVERY", 0);
    wanted.spares = number("FAULT_SPARES", 0);
    wanted.times = number("FAULT_TIMES", wanted.every ? 0x7fffffff : 1);
    wanted.log = getenv("FAULT_LOG");
    wanted.reads = number("FAULT_READS", 0);
}

// The first word of every dispatchable handle identifies the device (or instance) that it belongs to.
static void *key_of(const void *handle) { return *(void *const *)handle; }

static struct device *device_of(const void *handle) {
    for (int index = 0; index < 64; index++)
        if (devices[index].key == key_of(handle)) return &devices[index];
    abort();
}

// Counts a call on a device, or one that creates a device (null). Returns the error to inject, or VK_SUCCESS if the call
// is not to fail.
static VkResult judge(struct device *device, int call) {
    VkResult verdict = VK_SUCCESS;
    pthread_mutex_lock(&lock);
    if (device && device->lost) {
        verdict = call == ALLOCATE ? VK_SUCCESS : VK_ERROR_DEVICE_LOST;
    } else if (call == wanted.call && faults < wanted.times) {
        long count = wanted.climb && device ? ++device->calls : ++calls;
        long due = wanted.at + (wanted.climb ? faults : 0);
        int hit = count == due || (!wanted.climb && wanted.every && count > due && (count - due) % wanted.every == 0);
        if (wanted.spares && (count - 1) % wanted.spares == 0) hit = 0;
        if (hit) {
            faults++;
            verdict = wanted.result;
            if (device) device->lost = verdict == VK_ERROR_DEVICE_LOST;
            FILE *log = wanted.log ? fopen(wanted.log, "a") : NULL;
            if (log) {
                fprintf(log, "%s %ld %d\n", names[call], count, verdict);
                fclose(log);
            }
        }
    }
    pthread_mutex_unlock(&lock);
    return verdict;
}

// The parameters of a surface on X; declared here, because the headers of Vulkan would need those of X.
struct surface_info {
    VkStructureType type;
    const void *next;
    VkFlags flags;
    void *connection; // of XCB, or a display of Xlib
};

static _Atomic(long) read_until; // milliseconds; negative: no more reading
static pthread_t reader;
static int reads;

static long now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return time.tv_sec * 1000 + time.tv_nsec / 1000000;
}

// XCB queues events that it reads for other threads. A thread that waits for the socket does not look at the queue.
static void *read_on(void *connection) {
    struct extension { const char *name; int id; } present = {"Present", 0};
    void *xcb = dlopen("libxcb.so.1", RTLD_NOW);
    void *(*subscribe)(void *, struct extension *, unsigned, unsigned *) = (void *(*)(void *, struct extension *, unsigned, unsigned *))dlsym(xcb, "xcb_register_for_special_xge");
    void (*leave)(void *, void *) = (void (*)(void *, void *))dlsym(xcb, "xcb_unregister_for_special_event");
    void *(*poll)(void *, void *) = (void *(*)(void *, void *))dlsym(xcb, "xcb_poll_for_special_event");
    unsigned (*id)(void *) = (unsigned (*)(void *))dlsym(xcb, "xcb_generate_id");
    void *place = subscribe(connection, &present, id(connection), NULL);
    if (!place) abort();
    for (long until = read_until; until >= 0; until = read_until) {
        if (now() < until) free(poll(connection, place));
        else nanosleep(&(struct timespec){0, 1000000}, NULL);
    }
    leave(connection, place);
    return NULL;
}

static void begin_to_read(void *connection) {
    if (!wanted.reads || reads) return;
    read_until = 0;
    reads = !pthread_create(&reader, NULL, read_on, connection);
}

static struct instance *instance_of(VkInstance handle) {
    for (int index = 0; index < 64; index++)
        if (instances[index].key == key_of(handle)) return &instances[index];
    return NULL;
}

static VKAPI_ATTR VkResult VKAPI_CALL fault_CreateXlibSurfaceKHR(VkInstance handle, const struct surface_info *info, const VkAllocationCallbacks *allocator, VkSurfaceKHR *made) {
    void *library = dlopen("libX11-xcb.so.1", RTLD_NOW);
    begin_to_read(((void *(*)(void *))dlsym(library, "XGetXCBConnection"))(info->connection));
    return instance_of(handle)->of_xlib(handle, info, allocator, made);
}

static VKAPI_ATTR VkResult VKAPI_CALL fault_CreateXcbSurfaceKHR(VkInstance handle, const struct surface_info *info, const VkAllocationCallbacks *allocator, VkSurfaceKHR *made) {
    begin_to_read(info->connection);
    return instance_of(handle)->of_xcb(handle, info, allocator, made);
}

static VKAPI_ATTR void VKAPI_CALL fault_DestroySurfaceKHR(VkInstance handle, VkSurfaceKHR surface, const VkAllocationCallbacks *allocator) {
    if (reads) {
        read_until = -1;
        pthread_join(reader, NULL);
        reads = 0;
    }
    instance_of(handle)->unmake(handle, surface, allocator);
}

static VKAPI_ATTR VkResult VKAPI_CALL fault_QueueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo *infos, VkFence fence) {
    struct device *device = device_of(queue);
    VkResult verdict = judge(device, SUBMIT);
    return verdict ? verdict : device->QueueSubmit(queue, count, infos, fence);
}

static VKAPI_ATTR VkResult VKAPI_CALL fault_QueueSubmit2(VkQueue queue, uint32_t count, const VkSubmitInfo2 *infos, VkFence fence) {
    struct device *device = device_of(queue);
    VkResult verdict = judge(device, SUBMIT);
    return verdict ? verdict : device->QueueSubmit2(queue, count, infos, fence);
}

static VKAPI_ATTR VkResult VKAPI_CALL fault_WaitSemaphores(VkDevice handle, const VkSemaphoreWaitInfo *info, uint64_t timeout) {
    struct device *device = device_of(handle);
    VkResult verdict = judge(device, WAIT);
    return verdict ? verdict : device->WaitSemaphores(handle, info, timeout);
}

static VKAPI_ATTR VkResult VKAPI_CALL fault_WaitForFences(VkDevice handle, uint32_t count, const VkFence *fences, VkBool32 all, uint64_t timeout) {
    struct device *device = device_of(handle);
    VkResult verdict = judge(device, WAIT);
    return verdict ? verdict : device->WaitForFences(handle, count, fences, all, timeout);
}

static VKAPI_ATTR VkResult VKAPI_CALL fault_AllocateMemory(VkDevice handle, const VkMemoryAllocateInfo *info, const VkAllocationCallbacks *allocator, VkDeviceMemory *memory) {
    struct device *device = device_of(handle);
    VkResult verdict = judge(device, ALLOCATE);
    return verdict ? verdict : device->AllocateMemory(handle, info, allocator, memory);
}

static VKAPI_ATTR VkResult VKAPI_CALL fault_AcquireNextImageKHR(VkDevice handle, VkSwapchainKHR swapchain, uint64_t timeout, VkSemaphore semaphore, VkFence fence, uint32_t *index) {
    struct device *device = device_of(handle);
    VkResult verdict = judge(device, ACQUIRE);
    if (verdict < 0) return verdict;
    // "Suboptimal" is a success: there is an image.
    VkResult result = device->AcquireNextImageKHR(handle, swapchain, timeout, semaphore, fence, index);
    return result == VK_SUCCESS ? verdict : result;
}

static VKAPI_ATTR VkResult VKAPI_CALL fault_QueuePresentKHR(VkQueue queue, const VkPresentInfoKHR *info) {
    struct device *device = device_of(queue);
    VkResult verdict = judge(device, PRESENT);
    if (verdict == VK_ERROR_DEVICE_LOST) return verdict;
    // For all other errors the waits are still carried out, so the semaphores are free again.
    VkResult result = device->QueuePresentKHR(queue, info);
    if (reads && read_until >= 0) read_until = now() + wanted.reads;
    if (!verdict) return result;
    for (uint32_t index = 0; info->pResults && index < info->swapchainCount; index++) info->pResults[index] = verdict;
    return verdict;
}

static VKAPI_ATTR void VKAPI_CALL fault_DestroyDevice(VkDevice handle, const VkAllocationCallbacks *allocator) {
    if (!handle) return;
    struct device *device = device_of(handle);
    PFN_vkDestroyDevice destroy = device->DestroyDevice;
    pthread_mutex_lock(&lock);
    memset(device, 0, sizeof *device);
    pthread_mutex_unlock(&lock);
    destroy(handle, allocator);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL fault_GetDeviceProcAddr(VkDevice handle, const char *name);

static VKAPI_ATTR VkResult VKAPI_CALL fault_CreateDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo *info, const VkAllocationCallbacks *allocator, VkDevice *made) {
    VkResult verdict = judge(NULL, DEVICE);
    if (verdict) return verdict;
    VkLayerDeviceCreateInfo *link = (VkLayerDeviceCreateInfo *)info->pNext;
    while (link && !(link->sType == VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO && link->function == VK_LAYER_LINK_INFO))
        link = (VkLayerDeviceCreateInfo *)link->pNext;
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    PFN_vkGetInstanceProcAddr instance_next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    PFN_vkGetDeviceProcAddr next = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    PFN_vkCreateDevice create = (PFN_vkCreateDevice)instance_next(NULL, "vkCreateDevice");
    VkResult result = create ? create(physical, info, allocator, made) : VK_ERROR_INITIALIZATION_FAILED;
    if (result != VK_SUCCESS) return result;

    pthread_mutex_lock(&lock);
    struct device *device = NULL;
    for (int index = 0; index < 64 && !device; index++)
        if (!devices[index].key) device = &devices[index];
    if (!device) abort();
#define NEXT(name) device->name = (PFN_vk##name)next(*made, "vk" #name)
    device->key = key_of(*made);
    device->next = next;
    NEXT(DestroyDevice);
    NEXT(QueueSubmit);
    NEXT(QueueSubmit2);
    if (!device->QueueSubmit2) device->QueueSubmit2 = (PFN_vkQueueSubmit2)next(*made, "vkQueueSubmit2KHR");
    NEXT(WaitSemaphores);
    if (!device->WaitSemaphores) device->WaitSemaphores = (PFN_vkWaitSemaphores)next(*made, "vkWaitSemaphoresKHR");
    NEXT(WaitForFences);
    NEXT(AllocateMemory);
    NEXT(AcquireNextImageKHR);
    NEXT(QueuePresentKHR);
#undef NEXT
    pthread_mutex_unlock(&lock);
    return VK_SUCCESS;
}

static VKAPI_ATTR VkResult VKAPI_CALL fault_CreateInstance(const VkInstanceCreateInfo *info, const VkAllocationCallbacks *allocator, VkInstance *made) {
    VkLayerInstanceCreateInfo *link = (VkLayerInstanceCreateInfo *)info->pNext;
    while (link && !(link->sType == VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO && link->function == VK_LAYER_LINK_INFO))
        link = (VkLayerInstanceCreateInfo *)link->pNext;
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    PFN_vkGetInstanceProcAddr next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    PFN_vkCreateInstance create = (PFN_vkCreateInstance)next(NULL, "vkCreateInstance");
    VkResult result = create ? create(info, allocator, made) : VK_ERROR_INITIALIZATION_FAILED;
    if (result != VK_SUCCESS) return result;
    pthread_mutex_lock(&lock);
    if (!calls && !faults) read_wishes();
    int index = 0;
    while (index < 63 && instances[index].key && instances[index].key != key_of(*made)) index++;
    instances[index].key = key_of(*made);
    instances[index].next = next;
    // Looked up now, because later the loader would return the functions of this layer.
    instances[index].of_xlib = (surface_maker)next(*made, "vkCreateXlibSurfaceKHR");
    instances[index].of_xcb = (surface_maker)next(*made, "vkCreateXcbSurfaceKHR");
    instances[index].unmake = (PFN_vkDestroySurfaceKHR)next(*made, "vkDestroySurfaceKHR");
    pthread_mutex_unlock(&lock);
    return VK_SUCCESS;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL fault_GetInstanceProcAddr(VkInstance handle, const char *name);

#define OURS(function) \
    if (!strcmp(name, "vk" #function)) return (PFN_vkVoidFunction)fault_##function
#define OURS_ALSO(other, function) \
    if (!strcmp(name, "vk" #other)) return (PFN_vkVoidFunction)fault_##function

static PFN_vkVoidFunction ours_of_device(const char *name) {
    OURS(GetDeviceProcAddr);
    OURS(DestroyDevice);
    OURS(QueueSubmit);
    OURS(QueueSubmit2);
    OURS_ALSO(QueueSubmit2KHR, QueueSubmit2);
    OURS(WaitSemaphores);
    OURS_ALSO(WaitSemaphoresKHR, WaitSemaphores);
    OURS(WaitForFences);
    OURS(AllocateMemory);
    OURS(AcquireNextImageKHR);
    OURS(QueuePresentKHR);
    return NULL;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL fault_GetDeviceProcAddr(VkDevice handle, const char *name) {
    PFN_vkVoidFunction next = device_of(handle)->next(handle, name);
    PFN_vkVoidFunction ours = ours_of_device(name);
    // A function that the driver lacks is not offered by the layer either.
    return next && ours ? ours : next;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL fault_GetInstanceProcAddr(VkInstance handle, const char *name) {
    OURS(GetInstanceProcAddr);
    OURS(CreateInstance);
    OURS(CreateDevice);
    PFN_vkVoidFunction ours = ours_of_device(name);
    if (ours) return ours;
    if (!handle) return NULL;
    struct instance *instance = instance_of(handle);
    if (instance && instance->of_xlib) OURS(CreateXlibSurfaceKHR);
    if (instance && instance->of_xcb) OURS(CreateXcbSurfaceKHR);
    if (instance && instance->unmake) OURS(DestroySurfaceKHR);
    return instance ? instance->next(handle, name) : NULL;
}

__attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *version) {
    if (version->loaderLayerInterfaceVersion > 2) version->loaderLayerInterfaceVersion = 2;
    version->pfnGetInstanceProcAddr = fault_GetInstanceProcAddr;
    version->pfnGetDeviceProcAddr = fault_GetDeviceProcAddr;
    version->pfnGetPhysicalDeviceProcAddr = NULL;
    return VK_SUCCESS;
}
