Shader "ShaderToy/$name" {
    Properties {
        iChannel0 ("iChannel0", $property0 {} //? channel0
        iChannel1 ("iChannel1", $property1 {} //? channel1
        iChannel2 ("iChannel2", $property2 {} //? channel2
        iChannel3 ("iChannel3", $property3 {} //? channel3
        iMouse ("iMouse", Vector) = (0, 0, 0, 0) //? iMouse
        iDate ("iDate", Vector) = (2000, 0, 1, 0) //? iDate
        iFrame ("iFrame", Integer) = 0 //? iFrame
    }
    SubShader {
        Tags { "RenderType" = "Opaque" "PreviewType" = "Plane" }
        Cull Off
        ZWrite Off //? pass
        ZTest Always //? pass
        Pass {
            HLSLPROGRAM
            #pragma target 4.0
            #pragma vertex vertex
            #pragma fragment fragment
            #include "UnityCG.cginc"

            // The inputs of ShaderToy.
            #define iResolution float3(_ScreenParams.xy, 1.0) //? single
            float4 outputSize; //? pass
            #define iResolution float3(outputSize.xy, 1.0) //? pass
            #define iTime _Time.y //? iTime
            #define iTimeDelta unity_DeltaTime.x //? iTimeDelta
            #define iFrameRate unity_DeltaTime.w //? iFrameRate
            #define iSampleRate 44100.0 //? iSampleRate
            int iFrame; //? iFrame
            float4 iMouse; //? iMouse
            float4 iDate; //? iDate
            static float3 iChannelResolution[4]; //? iChannelResolution
            static float4 iChannelTime[4]; //? iChannelTime
            $texture0 iChannel0; //? channel0
            SamplerState sampleriChannel0; //? channel0&single
            #define iChannel0_sampler sampleriChannel0 //? channel0&single
            SamplerState $sampling0iChannel0_state; //? channel0&pass
            #define iChannel0_sampler $sampling0iChannel0_state //? channel0&pass
            float4 iChannel0_TexelSize; //? channel0&iChannelResolution
            $texture1 iChannel1; //? channel1
            SamplerState sampleriChannel1; //? channel1&single
            #define iChannel1_sampler sampleriChannel1 //? channel1&single
            SamplerState $sampling1iChannel1_state; //? channel1&pass
            #define iChannel1_sampler $sampling1iChannel1_state //? channel1&pass
            float4 iChannel1_TexelSize; //? channel1&iChannelResolution
            $texture2 iChannel2; //? channel2
            SamplerState sampleriChannel2; //? channel2&single
            #define iChannel2_sampler sampleriChannel2 //? channel2&single
            SamplerState $sampling2iChannel2_state; //? channel2&pass
            #define iChannel2_sampler $sampling2iChannel2_state //? channel2&pass
            float4 iChannel2_TexelSize; //? channel2&iChannelResolution
            $texture3 iChannel3; //? channel3
            SamplerState sampleriChannel3; //? channel3&single
            #define iChannel3_sampler sampleriChannel3 //? channel3&single
            SamplerState $sampling3iChannel3_state; //? channel3&pass
            #define iChannel3_sampler $sampling3iChannel3_state //? channel3&pass
            float4 iChannel3_TexelSize; //? channel3&iChannelResolution
            static float4 gl_FragCoord; //? position
            // The direction of y in the target, which depends on the graphics API. //? derivatives
            static float upward; //? derivatives

            $shader

            struct Varyings {
                float4 position : SV_POSITION;
                float2 uv : TEXCOORD0;
            };

            Varyings vertex(appdata_img input) {
                Varyings output;
                output.position = UnityObjectToClipPos(input.vertex);
                output.uv = input.texcoord;
                return output;
            }

            float4 fragment(Varyings input) : SV_Target {
                float2 fragCoord = input.uv * iResolution.xy;
                gl_FragCoord = float4(fragCoord, input.position.zw); //? position
                upward = ddy(fragCoord.y) < 0.0 ? -1.0 : 1.0; //? derivatives
                for (int i = 0; i < 4; i++) { //? iChannelTime
                    iChannelTime[i] = _Time.yyyy; //? iChannelTime
                } //? iChannelTime
                iChannelResolution[0] = float3(iChannel0_TexelSize.zw, 1.0); //? channel0&iChannelResolution
                iChannelResolution[1] = float3(iChannel1_TexelSize.zw, 1.0); //? channel1&iChannelResolution
                iChannelResolution[2] = float3(iChannel2_TexelSize.zw, 1.0); //? channel2&iChannelResolution
                iChannelResolution[3] = float3(iChannel3_TexelSize.zw, 1.0); //? channel3&iChannelResolution
                float4 color; //? out
                float4 color = float4(0.0, 0.0, 0.0, 1.0); //? inout
                $main_image(color, fragCoord);
                // ShaderToy shows its values as they are. //? image
                #ifndef UNITY_COLORSPACE_GAMMA //? image
                color.xyz = GammaToLinearSpace(saturate(color.xyz)); //? image
                #endif //? image
                return float4(color.xyz, 1.0); //? image
                return color; //? buffer
            }
            ENDHLSL
        }
    }
}
