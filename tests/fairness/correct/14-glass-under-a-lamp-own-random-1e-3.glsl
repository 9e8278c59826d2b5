// hash from iq's "integer hash - III"
uint sd;
float hash1() { sd = sd * 1103515245u + 12345u; uint n = (sd >> 16) ^ sd; n = n * 0x45d9f3bu; n = (n >> 16) ^ n; return float(n & 0xffffffu) / 16777216.0; }

vec4 sphs[2] = vec4[2](vec4(-.7, -.1, -4.2, .85), vec4(1.2, -.4, -4.8, .6));

float sphIntersect( in vec3 ro, in vec3 rd, in vec4 sph )
{
    vec3 oc = ro - sph.xyz;
    float b = dot( oc, rd );
    vec3 qc = oc - b*rd;
    float h = sph.w*sph.w - dot( qc, qc );
    if( h<0.0 ) return -1.0;
    h = sqrt( h );
    float t = -b-h;
    return t>0.001 ? t : -b+h;
}

float shadow( in vec3 ro, in vec3 rd, float far )
{
    for( int i=0; i<2; i++ )
    {
        float t = sphIntersect( ro, rd, sphs[i] );
        if( t>0.001 && t<far ) return 0.0;
    }
    return rd.y<0.0 && -(ro.y+1.0)/rd.y<far ? 0.0 : 1.0;
}

vec3 matte( vec3 pos, vec3 nor, vec3 alb )
{
    vec3 w = vec3(3,6,-3)-pos;
    float d2 = dot(w,w), d = sqrt(d2);
    w /= d;
    float cm = sqrt(1.0-1.44/d2);
    float ct = mix(1.0,cm,hash1()), st = sqrt(1.0-ct*ct), ph = 6.2831853*hash1();
    // Duff et al., Building an orthonormal basis, revisited
    float sg = w.z<0.0 ? -1.0 : 1.0;
    float a = -1.0/(sg+w.z), b = w.x*w.y*a;
    vec3 u = vec3(1.0+sg*w.x*w.x*a, sg*b, -sg*w.x), v = vec3(b, sg+w.y*w.y*a, -w.y);
    vec3 l = st*cos(ph)*u + st*sin(ph)*v + ct*w;
    float hit = d*ct - sqrt(max(0.0,1.44-d2*st*st));
    float dif = max(0.0,dot(nor,l));
    if( dif>0.0 ) dif *= shadow( pos+0.001*nor, l, hit );
    return alb*(0.2 + vec3(0.7,0.7,0.65)*dif);
}

vec3 render( vec3 ro, vec3 rd )
{
    vec3 so[6], dd[6]; float ww[6]; int lv[6], n=1;
    so[0]=ro; dd[0]=rd; ww[0]=1.0; lv[0]=1;
    vec3 tot = vec3(0.0);
    for( int k=0; k<40 && n>0; k++ )
    {
        n--;
        ro = so[n]; rd = dd[n]; float w = ww[n]; int lev = lv[n];
        float tg = sphIntersect(ro,rd,sphs[0]), tb = sphIntersect(ro,rd,sphs[1]), tp = -(ro.y+1.0)/rd.y;
        float t = 1e9; int id = -1;
        if( tg>0.001 && tg<t ) { t=tg; id=0; }
        if( tb>0.001 && tb<t ) { t=tb; id=1; }
        if( tp>0.001 && tp<t ) { t=tp; id=2; }
        if( id<0 ) { tot += w*vec3(0.5,0.6,0.75); continue; }
        vec3 pos = ro+t*rd;
        if( id==2 ) { tot += w*matte(pos,vec3(0,1,0),vec3(0.75,0.7,0.65)); continue; }
        if( id==1 ) { tot += w*matte(pos,normalize(pos-sphs[1].xyz),vec3(0.3,0.5,0.8)); continue; }
        if( lev==5 ) continue;
        vec3 nor = (pos-sphs[0].xyz)/sphs[0].w;
        float e = 1.0/1.5, ci = -dot(nor,rd);
        if( ci<0.0 ) { nor=-nor; ci=-ci; e=1.5; }
        vec3 r2 = refract(rd,nor,e);
        float fr = 1.0;
        if( dot(r2,r2)>0.0 )
        {
            float ct=-dot(nor,r2), x=(e*ci-ct)/(e*ci+ct), y=(e*ct-ci)/(e*ct+ci);
            fr = 0.5*(x*x+y*y);
            so[n]=pos; dd[n]=r2; ww[n]=w*(1.0-fr); lv[n]=lev+1; n++;
        }
        so[n]=pos; dd[n]=reflect(rd,nor); ww[n]=w*fr; lv[n]=lev+1; n++;
    }
    return tot;
}

void mainImage( out vec4 fragColor, in vec2 fragCoord )
{
    ivec2 q = ivec2(fragCoord);
    sd = uint(q.x)*1973u + uint(q.y)*9277u + uint(iFrame)*26699u | 1u;
    hash1(); sd ^= uint(q.y)*2654435769u; hash1();
    vec3 tot = vec3(0.0);
    for( int i=0; i<16; i++ )
    {
        vec2 o = vec2(hash1(),hash1())-0.5;
        vec2 p = (2.0*(fragCoord+o)-iResolution.xy)/iResolution.x;
        tot += render( vec3(0.0), normalize(vec3(p,-2.0)) );
    }
    fragColor = vec4( tot/16.0, 1.0 );
}
