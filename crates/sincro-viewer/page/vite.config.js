// Builds the page into one script and one style sheet, the same bytes on every machine.
import { defineConfig } from "vite";

export default defineConfig({
  build: {
    target: "es2022",
    outDir: "dist",
    emptyOutDir: true,
    minify: "esbuild",
    sourcemap: false,
    reportCompressedSize: true,
    lib: { entry: "src/main.ts", formats: ["iife"], name: "SincroViewer", fileName: () => "viewer.js", cssFileName: "viewer" },
  },
  esbuild: { legalComments: "inline", charset: "utf8" },
});
