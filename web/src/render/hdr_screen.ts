// A canvas of WebGPU that shows values above white, where the screen has them: the picture that WebGL2 has drawn as 16-bit numbers
// (shading/present_extended.glsl), as half floats of sRGB's curve continued.

const shader = `
@group(0) @binding(0) var packed: texture_2d<f32>;

@vertex fn vertex(@builtin(vertex_index) k: u32) -> @builtin(position) vec4f {
    return vec4f(4.0 * vec2f(f32(k & 1u), f32(k >> 1u)) - 1.0, 0.0, 1.0);
}
@fragment fn fragment(@builtin(position) place: vec4f) -> @location(0) vec4f {
    let p = vec2i(place.xy);
    let high = textureLoad(packed, p, 0).rgb;
    let low = textureLoad(packed, p + vec2i(0, i32(textureDimensions(packed).y / 2u)), 0).rgb;
    return vec4f((256.0 * round(255.0 * high) + round(255.0 * low)) * (4.0 / 65535.0), 1.0);
}`;

const k_format: GPUTextureFormat = 'rgba16float';
// GPUTextureUsage
const k_copy_from = 1, k_copy_to = 2, k_texture = 4, k_attachment = 16;

export class HdrScreen {
    readonly canvas = document.createElement('canvas');
    private readonly context: GPUCanvasContext;
    private readonly pipeline: GPURenderPipeline;
    private packed?: GPUTexture;
    private groups?: GPUBindGroup;

    /// source: the canvas of WebGL2. Null where the browser cannot do it.
    static async create(source: HTMLCanvasElement): Promise<HdrScreen | null> {
        const adapter = await navigator.gpu?.requestAdapter();
        const device = await adapter?.requestDevice();
        if (!device) return null;
        try {
            const screen = new HdrScreen(device, source);
            // A browser that does not know the member leaves it out.
            return screen.context.getConfiguration?.()?.toneMapping?.mode === 'extended' ? screen : null;
        } catch {
            return null;
        }
    }
    private constructor(
        private readonly device: GPUDevice,
        private readonly source: HTMLCanvasElement,
    ) {
        const context = this.canvas.getContext('webgpu') as GPUCanvasContext | null;
        if (!context) throw new Error('no context of WebGPU');
        this.context = context;
        context.configure({
            device, format: k_format, colorSpace: 'srgb', alphaMode: 'opaque', toneMapping: {mode: 'extended'}, usage: k_attachment | k_copy_from,
        });
        const module = device.createShaderModule({code: shader});
        this.pipeline = device.createRenderPipeline({layout: 'auto', vertex: {module}, fragment: {module, targets: [{format: k_format}]}});
    }

    /// Resolves when the graphics card is lost.
    get lost(): Promise<unknown> {
        return this.device.lost;
    }
    /// Shows what has just been drawn: called in the same task. width, height: of the picture, half as high as what was drawn.
    show(width: number, height: number): void {
        const {device, canvas, pipeline} = this;
        if (canvas.width !== width || canvas.height !== height || !this.packed) {
            Object.assign(canvas, {width, height});
            this.packed?.destroy();
            this.packed = device.createTexture({size: [width, 2 * height], format: 'rgba8unorm', usage: k_texture | k_copy_to | k_attachment});
            this.groups = device.createBindGroup({layout: pipeline.getBindGroupLayout(0), entries: [{binding: 0, resource: this.packed.createView()}]});
        }
        device.queue.copyExternalImageToTexture({source: this.source}, {texture: this.packed}, [width, 2 * height]);
        const encoder = device.createCommandEncoder();
        const pass = encoder.beginRenderPass({colorAttachments: [{view: this.context.getCurrentTexture().createView(), loadOp: 'clear', storeOp: 'store'}]});
        pass.setPipeline(pipeline);
        pass.setBindGroup(0, this.groups!);
        pass.draw(3);
        pass.end();
        device.queue.submit([encoder.finish()]);
    }
    dispose(): void {
        this.canvas.remove();
        this.device.destroy();
    }
}
