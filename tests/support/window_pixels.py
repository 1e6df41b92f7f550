"""The pixels of a window by libX11: a hundredth of the processor's time of a program that is started for each picture."""

import ctypes

ALL_PLANES, Z_PIXMAP = ctypes.c_ulong(-1), 2


class Image(ctypes.Structure):
    """The first fields of an XImage."""

    _fields_ = [(name, ctypes.c_int) for name in ("width", "height", "xoffset", "format")] + [
        ("data", ctypes.c_void_p)] + [(name, ctypes.c_int) for name in (
            "byte_order", "bitmap_unit", "bitmap_bit_order", "bitmap_pad", "depth", "bytes_per_line", "bits_per_pixel")]


class Connection:
    """To a display, such as ":99", for one window. An error of the server, as from a window that is gone, ends the process."""

    def __init__(self, display, window):
        self.x = ctypes.CDLL("libX11.so.6")
        for function in (self.x.XOpenDisplay, self.x.XDefaultRootWindow, self.x.XGetImage):
            function.restype = ctypes.c_void_p
        self.display = ctypes.c_void_p(self.x.XOpenDisplay(display.encode()))
        if not self.display:
            raise RuntimeError(f"no display {display}")
        self.root = ctypes.c_ulong(self.x.XDefaultRootWindow(self.display))
        self.window = ctypes.c_ulong(int(window))

    def close(self):
        self.x.XCloseDisplay(self.display)

    def size(self, drawable):
        root = ctypes.c_ulong()
        place = [ctypes.c_int(), ctypes.c_int()]
        width, height, border, depth = (ctypes.c_uint() for _ in range(4))
        self.x.XGetGeometry(self.display, drawable, *map(ctypes.byref, (root, *place, width, height, border, depth)))
        return width.value, height.value

    def grab(self):
        """Rows of 32-bit numbers, of the window's part that is on the screen."""
        self.x.XGrabServer(self.display)  # the window keeps its place and size
        left, top, child = ctypes.c_int(), ctypes.c_int(), ctypes.c_ulong()
        self.x.XTranslateCoordinates(self.display, self.window, self.root, 0, 0, *map(ctypes.byref, (left, top, child)))
        wide, high = self.size(self.root)
        width, height = self.size(self.window)
        x, y = max(0, -left.value), max(0, -top.value)
        width, height = min(width, wide - left.value) - x, min(height, high - top.value) - y
        image = self.x.XGetImage(self.display, self.window, x, y, width, height, ALL_PLANES, Z_PIXMAP)
        self.x.XUngrabServer(self.display)
        self.x.XFlush(self.display)
        if not image:
            raise RuntimeError("the window cannot be grabbed")
        told = Image.from_address(image)
        line, rows = told.bytes_per_line, told.height
        data = memoryview(ctypes.string_at(told.data, line * rows))
        self.x.XFree(ctypes.c_void_p(told.data))
        self.x.XFree(ctypes.c_void_p(image))
        return [data[line * y : line * (y + 1)].cast("I") for y in range(rows)]
